// Angles in a deck that appear to be in degrees.
#include <algorithm>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

const std::string kDeck = R"(
[space]
dimension = 3
min = [-1, -1, -1]
max = [1, 1, 1]
[time]
end = 1.0
[[bodies]]
name = "arm"
kind = "spatial"
mass = 1.0
inertia_tensor = [0.01, 0.02, 0.02, 0.0, 0.0, 0.0]
position = [0.3, 0.0, 0.0]
[[joints]]
name = "hinge"
type = "revolute"
bodies = ["ground", "arm"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 1.0, 0.0]
)";
const std::string kStop = "joint_limits=[{name=\"s\",joint=\"hinge\",stiffness=1e3,";
const std::string kPlanar = "bodies=[{name=\"b\",mass=1.0,inertia=0.1,position=[0,0,0],angle=";
const std::string kSlide =
    "joints=[{name=\"hinge\",type=\"translational\",bodies=[\"ground\",\"arm\"],axis=[1,0,0],point=[0,0,0]}]";

// Number of warnings about it.
std::ptrdiff_t found(const std::vector<std::string>& overrides,
                     const std::string& text = "angles are in radians") {
  const std::vector<std::string> warnings = model_warnings(kDeck, overrides);
  return std::ranges::count_if(warnings,
                               [&](const std::string& one) { return one.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("constant angles of more than a revolution are warned of") {
  const auto turned = [](const char* angle) {
    return std::vector<std::string>{"bodies.arm.rotation_axis=[1,0,0]",
                                    std::string("bodies.arm.rotation_angle=") + angle};
  };
  CHECK(found(turned("45.0"),
              "bodies.arm.rotation_angle = 45.0: 45 rad are 7.16 revolutions; angles are in radians: 45 "
              "degrees are 0.785398") == 1);
  CHECK(found(turned("-90")) == 1);
  CHECK(found(turned("6.283")) == 0);
  CHECK(found(turned("0.785398")) == 0);
  CHECK(found({kPlanar + "30.0}]", "joints=[]"}, "30 degrees are 0.523599") == 1);
}

TEST_CASE("limits of joints are warned of where they are angles and whole numbers") {
  CHECK(found({kStop + "lower=-90.0,upper=90.0}]"}) == 2);
  CHECK(found({kStop + "lower=-1.5707963267948966,upper=1.57}]"}) == 0);
  CHECK(found({kStop + "lower=-31.41592653589793,upper=31.4}]"}) == 0);  // of five revolutions
  CHECK(found({kStop + "lower=-90.0,upper=90.0}]", kSlide}) == 0);       // in metres
}

TEST_CASE("motions of drivers may be of many revolutions") {
  const std::string driver = "drivers=[{name=\"d\",joint=\"hinge\",motion=";
  CHECK(found({driver + "{kind=\"step\",value=0,end_value=90.0,start=0,end=1}}]"}) == 0);
  CHECK(found({driver + "{kind=\"sine\",amplitude=1.0,frequency=1.0,phase=90.0}}]"},
              ".phase = 90.0: 90 rad") == 1);
}

}  // namespace scree
