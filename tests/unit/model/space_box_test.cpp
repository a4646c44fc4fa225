// Points inside the domain, and beyond which of its sides others are.
#include "model/derived/space_box.hpp"

#include <limits>

#include "support/catch.hpp"

namespace scree {

namespace {

// x periodic, y from a wall to an open side, z open.
Space mixed_space(int dimension) {
  Space space;
  space.dimension = dimension;
  space.min = {-1, -1, dimension == 3 ? -1.0 : 0.0}, space.max = {1, 1, dimension == 3 ? 1.0 : 0.0};
  space.boundary = {Boundary::periodic, Boundary::periodic, Boundary::wall,
                    Boundary::open,     Boundary::open,     Boundary::open};
  return space;
}

}  // namespace

TEST_CASE("sides that are not periodic bound the space, z in 3D only") {
  const Box solid = open_box(mixed_space(3)), flat = open_box(mixed_space(2));
  for (const Box& box : {solid, flat}) {
    CHECK(box.inside({0, 0, 0}));
    CHECK(box.inside({1e9, 1, 0}));
    CHECK_FALSE(box.inside({0, 1.0000001, 0}));
    CHECK_FALSE(box.inside({0, -1.0000001, 0}));
    CHECK_FALSE(box.inside({0, std::numeric_limits<Real>::quiet_NaN(), 0}));
  }
  CHECK_FALSE(solid.inside({0, 0, 2}));
  CHECK(flat.inside({0, 0, 2}));
}

TEST_CASE("a margin counts inwards, a width outwards") {
  const Box box = open_box(mixed_space(2));
  CHECK(box.inside({0, 0.75, 0}, 0.25));
  CHECK_FALSE(box.inside({0, 0.75, 0}, 0.5));
  CHECK(box.is_within({0, -1.25, 0}, 0.25));
  CHECK_FALSE(box.is_within({0, -1.5, 0}, 0.25));
}

TEST_CASE("beyond a wall is past that side alone") {
  const Box walls = wall_box(mixed_space(3));
  CHECK(walls.beyond({0, -1.5, 0}));
  CHECK_FALSE(walls.beyond({0, 1.5, 0}));
  CHECK_FALSE(walls.beyond({5, 0, 5}));
  CHECK_FALSE(walls.beyond({0, std::numeric_limits<Real>::quiet_NaN(), 0}));
}

TEST_CASE("at the start periodic sides are far, but not at infinity") {
  const Box start = start_box(mixed_space(3));
  CHECK(start.inside({2e6, 0, 0}));
  CHECK_FALSE(start.inside({2.1e6, 0, 0}));
  CHECK_FALSE(start.inside({0, 1.5, 0}));
}

}  // namespace scree
