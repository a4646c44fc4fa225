// Overlaps with meshes at the start, and random groups clear of them.
#include "model/derived/posed_meshes.hpp"

#include <fmt/format.h>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kSpace = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
end = 1.0
step = 1e-3
control = "fixed"
[[contact.pairs]]
stiffness = 1e4
[[meshes]]
name = "cube"
kind = "box"
size = [0.4, 0.4, 0.4]
[[meshes]]
name = "floor"
kind = "rectangle"
size = [1.0, 1.0]
offset = [0.0, 0.0, -0.8]
)";

const std::string kRock = R"(
[[walls]]
name = "rock"
mesh = "cube"
[[walls]]
name = "floor"
mesh = "floor"
)";

const std::string kTurned = R"(
[[bodies]]
name = "crate"
kind = "spatial"
position = [0.5, 0.5, 0.5]
rotation_axis = [0, 0, 1]
rotation_angle = 0.7853981633974483
meshes = [{ mesh = "cube" }]
solids = [{ kind = "mesh", mesh = "cube", density = 100.0 }]
)";

std::string at(const std::string& positions) {
  return "[[particles]]\nkind = \"list\"\nradius = 0.05\nmass = 1.0\npositions = " + positions + "\n";
}

// The finding without the surrounding text.
std::string overlap(const std::string& deck) {
  const std::string message = model_error(deck);
  const std::size_t first = message.find(": particle");
  return first == std::string::npos ? message : message.substr(first + 2, message.find(';') - first - 2);
}

}  // namespace

TEST_CASE("overlaps with meshes of walls: face, edge, corner, and any depth inside") {
  const std::string deck = kSpace + kRock;
  const auto finding = [&](const std::string& positions) { return overlap(deck + at(positions)); };
  const std::string rock = "particle 0 and wall \"rock\" overlap at t = 0 by ";
  CHECK(finding("[[0.25, 0, 0]]").empty());
  CHECK(finding("[[0.24, 0, 0]]") == rock + "0.2 of the smaller radius");
  CHECK(finding("[[0.23, 0.24, 0]]").empty());
  CHECK(finding("[[0.224, 0.232, 0]]") == rock + "0.2 of the smaller radius");
  CHECK(finding("[[0.19, 0, 0]]") == rock + "1.2 of the smaller radius");
  CHECK(finding("[[0.1, 0, 0]]") == rock + "2 of the smaller radius");
  CHECK(finding("[[0, 0, 0]]") == rock + "2 of the smaller radius");
  // An open surface has two sides, and no inside.
  CHECK(finding("[[0.3, 0, -0.84]]") ==
        "particle 0 and wall \"floor\" overlap at t = 0 by 0.2 of the smaller radius");
  CHECK(finding("[[0.3, 0, -0.76]]") ==
        "particle 0 and wall \"floor\" overlap at t = 0 by 0.2 of the smaller radius");
  CHECK(finding("[[0.3, 0, -0.9]]").empty());
}

TEST_CASE("overlaps with meshes of bodies that are rotated, moved, and across periodic sides") {
  const auto finding = [&](const std::string& positions) {
    return overlap(kSpace + kTurned + at(positions));
  };
  // The edge of the cube, which is rotated by 45 degrees, points along x.
  CHECK(finding("[[0.5, 0.84, 0.5]]").empty());
  CHECK(contains(finding("[[0.5, 0.82284271247461901, 0.5]]"),
                 "particle 0 and body \"crate\" overlap at t = 0 by 0.2 of"));
  CHECK(finding("[[0.68, 0.68, 0.5]]").empty());
  const std::vector<std::string> sides{"space.x_min=periodic", "space.x_max=periodic"};
  const std::string moved = kSpace + kTurned + at("[[-0.9, 0.5, 0.5]]");
  CHECK(model_error(moved, sides).empty());
  std::vector<std::string> across = sides;
  across.push_back("bodies.crate.position=[0.8, 0.5, 0.5]");
  CHECK(
      contains(model_error(moved, across), "particle 0 and body \"crate\" overlap at t = 0 by 0.656854 of"));
  across.back() = "bodies.crate.position=[-9.2, 0.5, 0.5]";
  CHECK(
      contains(model_error(moved, across), "particle 0 and body \"crate\" overlap at t = 0 by 0.656854 of"));
}

TEST_CASE("a mesh as long as the periodic domain continues beyond its sides") {
  const std::vector<std::string> overrides{"space.x_min=periodic", "space.x_max=periodic",
                                           "meshes.floor.size=[2, 1]", "meshes.floor.offset=[0.7, 0, -0.8]"};
  for (const char* x : {"-0.99", "-0.3", "0.7", "0.99"}) {
    const std::string message =
        model_error(kSpace + kRock + at(fmt::format("[[{}, 0, -0.77]]", x)), overrides);
    CHECK(contains(message, "particle 0 and wall \"floor\" overlap at t = 0 by 0.4 of"));
    CHECK(model_error(kSpace + kRock + at(fmt::format("[[{}, 0, -0.75]]", x)), overrides).empty());
  }
}

TEST_CASE("in 2D: closed lines and open ones, on planar bodies, too") {
  const std::string deck = kSmallDeck + R"(
[[contact.pairs]]
stiffness = 1e4
[[meshes]]
name = "wedge"
kind = "line"
closed = true
points = [[0.0, 0.0], [0.4, 0.0], [0.0, 0.4]]
[[bodies]]
name = "wedge"
position = [-0.5, -0.5]
angle = 1.5707963267948966
mass = 1.0
inertia = 1.0
meshes = [{ mesh = "wedge" }]
)";
  CHECK(overlap(deck + at("[[-0.44, -0.3]]")).empty());
  CHECK(contains(overlap(deck + at("[[-0.6, -0.4]]")), "body \"wedge\" overlap at t = 0 by 2 of"));
  CHECK(contains(overlap(deck + at("[[-0.46, -0.3]]")), "body \"wedge\" overlap at t = 0 by 0.2 of"));
  const std::string inside = model_error(deck + at("[[-0.6, -0.4]]"));
  CHECK(contains(
      inside,
      "; body \"wedge\": its mesh \"wedge\"; the centre of particle 0 is inside the solid that mesh "
      "\"wedge\" encloses: without closed = true, and with the first point again at the end, it is a "
      "container"));
  const std::vector<std::string> container{"meshes.wedge.closed=false",
                                           "meshes.wedge.points=[[0, 0], [0.4, 0], [0, 0.4], [0, 0]]"};
  CHECK(model_error(deck + at("[[-0.6, -0.4]]"), container).empty());
}

TEST_CASE("random groups keep clear of meshes") {
  const std::string group = R"(
[[particles]]
kind = "random"
count = 800
radius = 0.04
mass = 1.0
gap = 0.004
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
)";
  const Model model = model_of(kSpace + kRock + kTurned + group);
  const PosedMeshes meshes(model);
  REQUIRE(meshes.all().size() == 3);
  REQUIRE(model.particles.size() == 800);
  int clear = 0, near = 0;
  for (const Vec3 p : model.particles.position) {
    clear += meshes.is_clear(p, 0.04, 0.004);
    near += !meshes.is_clear(p, 0.04, 0.1);
  }
  CHECK(clear == 800);
  CHECK(near > 10);
  const std::string none = model_error(
      kSpace + kRock + group,
      {"particles.0.min=[-0.15, -0.15, -0.15]", "particles.0.max=[0.15, 0.15, 0.15]", "particles.0.count=1"});
  CHECK(contains(none, "only 0 particles found a position in 10000 tries each"));
}

}  // namespace scree
