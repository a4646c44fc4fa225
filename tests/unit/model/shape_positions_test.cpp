// Rows and arrays of shapes, and shapes without contacts.
#include "model/derived/shape_positions.hpp"

#include <algorithm>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

// A body at the origin with this entry of its shapes.
std::string with_shape(const std::string& shape, int dimension = 2, const std::string& body = "") {
  const std::string zeros = dimension == 2 ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]";
  std::string deck =
      "[space]\ndimension = " + std::to_string(dimension) +
      (dimension == 2 ? "\nmin = [-1, -1]\nmax = [1, 1]\n" : "\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n") +
      "[time]\nend = 1.0\n";
  return deck + "[[bodies]]\nname = \"bin\"\nmass = 1.0\ninertia = 1.0\nposition = " + zeros + "\n" + body +
         "shapes = [{ radius = 0.05, " + shape + " }]\n";
}

ShapePositions positions_of(const std::string& shape, int dimension = 2) {
  const Deck deck = parse_deck(with_shape(shape, dimension), "deck.toml", {});
  return {deck.root.tables("bodies").front().tables("shapes").front(), dimension};
}

std::vector<Vec3> all_of(const ShapePositions& places) {
  std::vector<Vec3> all;
  places.for_each([&](Vec3 place) { all.push_back(place); });
  return all;
}

std::string error_of(const std::string& shape, int dimension = 2) {
  return model_error(with_shape(shape, dimension));
}

}  // namespace

TEST_CASE("a row of shapes begins at its offset, an array is filled along x first") {
  CHECK(all_of(positions_of("offset = [0.5, 0.25]")) == std::vector<Vec3>{{0.5, 0.25, 0}});
  CHECK(all_of(positions_of("offset = [0.5, 0.0], count = 3, spacing = [-0.25, 0.5]")) ==
        std::vector<Vec3>{{0.5, 0, 0}, {0.25, 0.5, 0}, {0, 1, 0}});
  CHECK(all_of(positions_of("size = [2, 3], spacing = [0.25, 0.5]")) ==
        std::vector<Vec3>{{0, 0, 0}, {0.25, 0, 0}, {0, 0.5, 0}, {0.25, 0.5, 0}, {0, 1, 0}, {0.25, 1, 0}});
  const Model model = model_of(with_shape("size = [3, 2, 2], spacing = [0.125, 0.25, 0.5]", 3));
  REQUIRE(model.bodies.front().shapes.size() == 12);
  CHECK(model.bodies.front().shapes.back().offset == Vec3{0.25, 0.25, 0.5});
}

TEST_CASE("sides of an array are an outline or a tray") {
  const auto inside = [](Vec3 p) { return p.x > 0 && p.x < 0.75 && p.y > 0 && p.y < 0.5; };
  const std::string array = "size = [4, 3], spacing = [0.25, 0.25], sides = ";
  const std::vector<Vec3> outline = all_of(positions_of(array + R"(["x_min", "x_max", "y_min", "y_max"])"));
  CHECK(outline.size() == 10);
  CHECK(std::ranges::none_of(outline, inside));
  CHECK(all_of(positions_of(array + R"(["x_min", "x_max", "y_min"])")).size() == 8);
  CHECK(all_of(positions_of(array + R"(["y_max"])")) ==
        std::vector<Vec3>{{0, 0.5, 0}, {0.25, 0.5, 0}, {0.5, 0.5, 0}, {0.75, 0.5, 0}});
}

TEST_CASE("of any sides the count is right, and all shapes lie between the corners") {
  constexpr std::array<const char*, kSides> names = kSideNames;
  for (const char* size : {"[3, 4, 2]", "[1, 3, 3]", "[2, 1, 1]"}) {
    for (unsigned sides = 0; sides < 64; ++sides) {
      std::string list;
      for (unsigned s = 0; s < names.size(); ++s)
        if ((sides >> s & 1) != 0) list += (list.empty() ? "\"" : ", \"") + std::string(names[s]) + '"';
      CAPTURE(size, list);
      const ShapePositions places =
          positions_of("size = " + std::string(size) + ", spacing = [0.25, 0.25, 0.25]" +
                           (list.empty() ? "" : ", sides = [" + list + "]"),
                       3);
      const std::vector<Vec3> all = all_of(places), corners = places.corners();
      REQUIRE(std::ssize(all) == places.count());
      for (const Real Vec3::*along : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        const auto [low, high] = std::ranges::minmax(all, {}, along);
        const auto [first, last] = std::ranges::minmax(corners, {}, along);
        REQUIRE((low.*along == first.*along && high.*along == last.*along));
      }
    }
  }
}

TEST_CASE("incompatible keys of shapes are refused by name and line") {
  CHECK(contains(error_of("count = 2"), "deck.toml:"));
  CHECK(contains(error_of("count = 2"), "bodies.bin.shapes.0.spacing: missing"));
  CHECK(contains(error_of("spacing = [0.1, 0.0]"), "give count for a row or size for an array"));
  CHECK(contains(error_of("count = 2, size = [2, 2], spacing = [0.1, 0.1]"), "not used together with count"));
  CHECK(contains(error_of("count = 0, spacing = [0.1, 0.1]"), "must be an integer from 1 to 10000000"));
  CHECK(contains(error_of("count = 2, spacing = [0.0, 0.0]"), "must not be 0"));
  CHECK(contains(error_of("size = [2, 0], spacing = [0.1, 0.1]"), "at least 1"));
  CHECK(contains(error_of("size = [2], spacing = [0.1, 0.1]"), "must have 2 entries"));
  CHECK(contains(error_of("size = [100000, 1000], spacing = [0.1, 0.1]"), "at most 10000000 places"));
  CHECK(contains(error_of("size = [2, 2], spacing = [0.1, -0.1]"), "must be above 0 along y"));
  CHECK(contains(error_of("count = 2, spacing = [0.1, 0.1], sides = [\"x_min\"]"), "needs size"));
  const std::string array = "size = [2, 2], spacing = [0.1, 0.1], sides = ";
  CHECK(contains(error_of(array + "[\"left\"]"), "there is no side \"left\""));
  CHECK(contains(error_of(array + "[\"z_min\"]"), "there is no side \"z_min\""));
  CHECK(contains(error_of(array + "[\"x_min\", \"x_min\"]"), "\"x_min\" is repeated"));
  CHECK(contains(error_of(array + "[]"), "must name one side at least: x_min, x_max, y_min, y_max"));
  CHECK(contains(error_of("count = 30, spacing = [0.1, 0.0]"), "body \"bin\" starts at (2.9"));
}

TEST_CASE("shapes without contacts touch nothing, wherever they are") {
  const Model model = model_of(with_shape("offset = [5.0, 0.0], collides = false"));
  CHECK(model.bodies.front().shapes.empty());
  REQUIRE(model.bodies.front().drawn_shapes.size() == 1);
  CHECK(model.bodies.front().drawn_shapes.front().offset == Vec3{5, 0, 0});
  CHECK(model_of(with_shape("count = 2, spacing = [0.5, 0.0]", 2, "collides = false\n"))
            .bodies.front()
            .drawn_shapes.size() == 2);
  // With several materials only shapes with contacts must have one.
  const std::string materials = "[[materials]]\nname = \"a\"\n[[materials]]\nname = \"b\"\n";
  CHECK(contains(model_error(with_shape("collides = true") + materials), "material: missing"));
  CHECK(model_error(with_shape("collides = false") + materials).empty());
  CHECK(contains(model_error(with_shape("collides = false, material = \"c\"") + materials), "\"c\""));
}

}  // namespace scree
