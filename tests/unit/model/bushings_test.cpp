// Bushings built from a deck.
#include <fmt/format.h>

#include "model/checks/memory.hpp"
#include "model/derived/connections.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kDeck = R"([space]
dimension = 3
min = [-2.0, -2.0, -2.0]
max = [2.0, 2.0, 2.0]
[time]
end = 1.0
step = 1e-3
control = "fixed"
[[bodies]]
name = "link"
kind = "spatial"
count = 3
spacing = [0.2, 0.0, 0.0]
mass = 1.0
inertia_tensor = [0.1, 0.1, 0.1, 0.0, 0.0, 0.0]
position = [0.1, 0.0, 0.0]
rotation_axis = [0.0, 0.0, 1.0]
rotation_angle = 1.5707963267948966
[[bodies]]
name = "flat"
mass = 1.0
inertia = 0.1
position = [0.0, 1.0, 0.0]
)";

std::string bushing(const std::string& rest) { return kDeck + "[[bushings]]\nname = \"b\"\n" + rest; }
const std::string kAtMarker = "bodies = [\"ground\", \"link.0\"]\npoint = [0.0, 0.0, 0.5]\n";
const std::string kSoft = "stiffness = [1, 2, 3, 4, 5, 6]\n";

// 36 numbers: a diagonal of ones with one other pair.
std::string matrix(int row, int column, Real value, Real mirrored) {
  std::string text = "[";
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      text += fmt::format("{}, ", i == row && j == column   ? value
                                  : i == column && j == row ? mirrored
                                  : i == j                  ? 1.0
                                                            : 0.0);
  return text + "]\n";
}

std::string refusal(const std::string& rest) {
  return input_error([&] { model_of(bushing(rest)); });
}

}  // namespace

TEST_CASE("a bushing has its point and axes in both bodies, and its matrices") {
  const std::string axes = "axis = [0.0, 2.0, 0.0]\nsecond_axis = [0.0, 0.0, 3.0]\n";
  const Model model = model_of(bushing(kAtMarker + axes + kSoft + "damping = " + matrix(1, 4, 0.5, 0.5) +
                                       "preload = [1, 2, 3, 4, 5, 6]\n"));
  const Bushing& b = model.bushings.at(0);
  CHECK(b.body[0] == kGround);
  CHECK(near(b.point[0], Vec3{0, 0, 0.5}, {.absolute = 1e-15}));
  CHECK(near(b.point[1], Vec3{0, 0.1, 0.5}, {.absolute = 1e-15}));
  // z along y and x along z, so y along x; the body is rotated by a quarter revolution about z.
  for (int side = 0; side < 2; ++side) {
    const auto global = [&](Vec3 own) {
      return to_global_direction(model, b.body[side], rotation_matrix(b.marker[side]) * own);
    };
    CHECK(near(global({0, 0, 1}), Vec3{0, 1, 0}, {.absolute = 1e-15}));
    CHECK(near(global({1, 0, 0}), Vec3{0, 0, 1}, {.absolute = 1e-15}));
    CHECK(near(global({0, 1, 0}), Vec3{1, 0, 0}, {.absolute = 1e-15}));
  }
  CHECK(b.stiffness[4][4] == 5);
  CHECK(b.stiffness[0][1] == 0);
  CHECK(b.damping[4][1] == 0.5);
  CHECK(b.preload[5] == 6);
}

TEST_CASE("a bushing between markers is the one at their point and axes") {
  // On the body from an origin off its centre of mass, in whose frame the marker is.
  const std::string markers =
      kDeck +
      "[[bodies]]\nname = \"arm\"\nkind = \"spatial\"\nmass = 1.0\nposition = [1.0, 0.0, 0.0]\n"
      "inertia_tensor = [0.1, 0.1, 0.1, 0.0, 0.0, 0.0]\ncenter_of_mass = [0.0, 0.2, 0.0]\n"
      "rotation_axis = [0.0, 0.0, 1.0]\nrotation_angle = 1.5707963267948966\n"
      "[[markers]]\nname = \"frame\"\nbody = \"ground\"\nlocal_point = [1.0, 0.0, 0.5]\n"
      "z_axis = [0.0, 1.0, 0.0]\nx_axis = [0.0, 0.0, 1.0]\n"
      "[[markers]]\nname = \"foot\"\nbody = \"arm\"\nlocal_point = [0.0, 0.0, 0.5]\n"
      "z_axis = [1.0, 0.0, 0.0]\nx_axis = [0.0, 0.0, 1.0]\n[[bushings]]\nname = \"b\"\n" +
      kSoft;
  const Bushing a = model_of(markers + "markers = [\"frame\", \"foot\"]\n").bushings.at(0);
  const Bushing b = model_of(markers +
                             "bodies = [\"ground\", \"arm\"]\npoint = [1.0, 0.0, 0.5]\n"
                             "axis = [0.0, 1.0, 0.0]\nsecond_axis = [0.0, 0.0, 1.0]\n")
                        .bushings.at(0);
  CHECK(a.body[1] == b.body[1]);
  for (int side = 0; side < 2; ++side) {
    CHECK(near(a.point[side], b.point[side], {.absolute = 1e-15}));
    const Mat3 one = rotation_matrix(a.marker[side]), other = rotation_matrix(b.marker[side]);
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      CHECK(near(one * axis, other * axis, {.absolute = 1e-15}));
  }
  CHECK(near(a.point[1], Vec3{0, -0.2, 0.5}, {.absolute = 1e-15}));  // from the centre of mass
}

TEST_CASE("markers of a bushing that differ by more than its valid rotation are refused") {
  const auto deck = [](Real angle, const std::string& stiffness) {
    return kDeck +
           fmt::format(
               "[[markers]]\nname = \"frame\"\nbody = \"ground\"\nrotation_axis = [1.0, 1.0, 0.0]\n"
               "rotation_angle = {}\n[[bodies]]\nname = \"arm\"\nkind = \"spatial\"\nmass = 1.0\n"
               "position = [1.0, 0.0, 0.0]\ninertia_tensor = [0.1, 0.1, 0.1, 0.0, 0.0, 0.0]\n"
               "[[markers]]\nname = \"foot\"\nbody = \"arm\"\n[[bushings]]\nname = \"b\"\n"
               "markers = [\"frame\", \"foot\"]\n",
               angle) +
           stiffness;
  };
  CHECK(contains(input_error([&] { model_of(deck(2.7, kSoft)); }),
                 "bushings.b.markers = [\"frame\", \"foot\"]: their frames are rotated by 2.7 rad relative "
                 "to each other at t = 0; a bushing allows up to 2.6 rad"));
  CHECK(model_of(deck(2.5, kSoft)).bushings.size() == 1);
  CHECK(model_of(deck(2.7, "stiffness = [1, 2, 3, 0, 0, 0]\n")).bushings.size() == 1);
}

TEST_CASE("a row of bushings is counted and keeps its bodies from touching") {
  const std::string row =
      bushing("chain = \"link\"\nlocal_points = [[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]]\n" + kSoft);
  const Model model = model_of(row);
  REQUIRE(model.bushings.size() == 2);
  CHECK(model.bushings[1].name == "b.1");
  CHECK(connected_bodies(model) == std::vector<std::pair<int, int>>{{0, 1}, {1, 2}});
  CHECK(bodies_and_joints(parse_deck(row, "deck.toml", {}).root).links == 3);  // at most: one for each body
}

TEST_CASE("invalid bushings are refused with the key and the allowed values") {
  const auto refused = [](const std::string& rest, const std::string& key, const std::string& text) {
    INFO(rest);
    const std::string message = refusal(rest);
    INFO(message);
    CHECK(contains(message, key));
    CHECK(contains(message, text));
  };
  refused(kAtMarker, "bushings.b.stiffness", "missing");
  refused("bodies = [\"ground\", \"link.0\"]\n" + kSoft, "bushings.b.point", "exactly one of the keys");
  refused(kAtMarker + "local_points = [[0, 0, 0], [0, 0, 0]]\n" + kSoft, "bushings.b.point", "exactly one");
  refused("bodies = [\"ground\", \"flat\"]\npoint = [0, 1, 0]\n" + kSoft, "bushings.b.bodies",
          "between spatial bodies");
  refused("bodies = [\"link.0\", \"flat\"]\npoint = [0, 1, 0]\n" + kSoft, "bushings.b.bodies",
          "both must be of one kind");
  refused("chain = \"link\"\npoint = [0, 1, 0]\n" + kSoft, "bushings.b.point", "not used with chain or each");
  refused("markers = [\"a\", \"b\"]\n" + kSoft, "bushings.b.markers", "marker");
  refused(kAtMarker + kSoft + "axis = [1, 0, 0]\n", "bushings.b.axis", "belong together");
  refused(kAtMarker + kSoft + "axis = [1, 0, 0]\nsecond_axis = [0.1, 1, 0]\n", "bushings.b.second_axis",
          "must be perpendicular to axis");
  refused(kAtMarker + kSoft + "axis = [0, 0, 0]\nsecond_axis = [0, 1, 0]\n", "bushings.b.axis",
          "must not be 0");
  refused(kAtMarker + "stiffness = [1, 2, 3]\n", "bushings.b.stiffness",
          "must have 6 entries, its diagonal, or 36, row by row; it has 3");
  refused(kAtMarker + "stiffness = [1, 1, 1, 1, -2, 1]\n", "bushings.b.stiffness",
          "its diagonal entry 5 is -2, below 0");
  refused(kAtMarker + "stiffness = " + matrix(3, 1, 0.25, 0.5), "bushings.b.stiffness",
          "is not symmetric: row 4, column 2 is 0.25, row 2, column 4 is 0.5");
  refused(kAtMarker + "stiffness = " + matrix(0, 4, 1.1, 1.1), "bushings.b.stiffness",
          "is not positive semidefinite: of its first 5 rows");
  refused(kAtMarker + kSoft + "damping = " + matrix(0, 4, -1.1, -1.1), "bushings.b.damping",
          "is not positive semidefinite");
  refused(kAtMarker + kSoft + "preload = [1, 2]\n", "bushings.b.preload", "6");
  // On the boundary: a deflection without energy.
  CHECK(model_of(bushing(kAtMarker + "stiffness = " + matrix(0, 4, 1, 1))).bushings.size() == 1);
  CHECK(model_of(bushing(kAtMarker + "stiffness = [0, 0, 0, 0, 0, 1]\n")).bushings.size() == 1);
}

TEST_CASE("a zero on the diagonal with something beside it is refused") {
  std::string text = "[";
  for (int i = 0; i < 36; ++i) text += i == 1 || i == 6 ? "0.5, " : i % 7 == 0 && i > 0 ? "1, " : "0, ";
  CHECK(contains(refusal(kAtMarker + "stiffness = " + text + "]\n"), "beside a 0 on the diagonal"));
}

}  // namespace scree
