#include "physics/outlet_region.hpp"

#include "support/catch.hpp"

namespace scree {

namespace {

OutletRegion region(OutletShape shape) {
  OutletRegion out;
  out.shape = shape, out.origin = {1, 2, 3};
  // A quarter turn about x: the local z axis is -y.
  out.x = {1, 0, 0}, out.y = {0, 0, 1}, out.z = {0, -1, 0};
  return out;
}

}  // namespace

TEST_CASE("a box contains the points between its bounds along its own axes") {
  OutletRegion box = region(OutletShape::box);
  box.min = {-1, -1, 0}, box.max = {1, 1, 0.5};
  CHECK((box.contains({1, 2, 3}) && box.contains({2, 1.5, 4})));
  CHECK_FALSE((box.contains({1, 2.1, 3}) || box.contains({1, 1.4, 3})));
  CHECK_FALSE((box.contains({2.1, 1.8, 3}) || box.contains({1, 1.8, 4.1})));
}

TEST_CASE("a box with one bound is a half space") {
  OutletRegion half = region(OutletShape::box);
  half.min = {-kInfinity, -kInfinity, 0}, half.max = {kInfinity, kInfinity, kInfinity};
  CHECK((half.contains({1e9, 2, -1e9}) && half.contains({0, -1e30, 0})));
  CHECK_FALSE(half.contains({0, 2.001, 0}));
}

TEST_CASE("a cylinder is about its local z axis, a sphere about its centre") {
  OutletRegion round = region(OutletShape::cylinder);
  round.radius = 0.5, round.min.z = 0, round.max.z = 2;
  CHECK((round.contains({1, 2, 3}) && round.contains({1.5, 0, 3}) && round.contains({1, 1, 3.49})));
  CHECK_FALSE(
      (round.contains({1, 2.01, 3}) || round.contains({1, -0.01, 3}) || round.contains({1.4, 1, 3.4})));
  round.shape = OutletShape::sphere;
  CHECK((round.contains({1.5, 2, 3}) && round.contains({1, 2.3, 3.3})));
  CHECK_FALSE((round.contains({1.4, 2.4, 3}) || round.contains({1, 1, 3})));
}

}  // namespace scree
