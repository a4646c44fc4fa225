// Mass, centre of mass and inertia of solids against values computed by hand.
#include "physics/solid_body.hpp"

#include <numbers>

#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

void check_near(const Sym3& a, const Sym3& b) {
  const auto same = [](Real x, Real y) { return near(x, y, {.relative = 1e-14, .absolute = 1e-15}); };
  CHECK(same(a.xx, b.xx));
  CHECK(same(a.yy, b.yy));
  CHECK(same(a.zz, b.zz));
  CHECK(same(a.xy, b.xy));
  CHECK(same(a.xz, b.xz));
  CHECK(same(a.yz, b.yz));
}

}  // namespace

TEST_CASE("solids about their own centres") {
  const MassProperties ball = solid_sphere(3, 2);
  CHECK(near(ball.mass, 32 * kPi, {.relative = 1e-15}));
  check_near(ball.inertia, {51.2 * kPi, 0, 0, 51.2 * kPi, 0, 51.2 * kPi});
  const MassProperties box = solid_box(2, {1, 2, 3});  // 12 kg
  CHECK(box.mass == 12);
  check_near(box.inertia, {13, 0, 0, 10, 0, 5});
  const MassProperties rod = solid_cylinder(1 / kPi, 2, 3);  // 12 kg
  CHECK(near(rod.mass, 12, {.relative = 1e-15}));
  check_near(rod.inertia, {21, 0, 0, 21, 0, 24});
  // 12 kg of cylinder and 32/3 kg of ends: J = 24 + 4.2667 * 4; across 21 + 10.667 (1.6 + 2.25 + 2.25).
  const MassProperties capsule = solid_capsule(1 / kPi, 2, 3);
  CHECK(near(capsule.mass, 12 + 32. / 3, {.relative = 1e-15}));
  const Real along = 24 + 32. / 3 * 1.6, across = 21 + 32. / 3 * 6.1;
  check_near(capsule.inertia, {across, 0, 0, across, 0, along});
}

// The capsule of the test above, as a sum over thin discs along its axis.
TEST_CASE("a capsule is the sum of its slices") {
  constexpr Real kRadius = 0.3, kLength = 0.5, kDensity = 7;
  constexpr int kSlices = 20000;
  const Real thickness = (kLength + 2 * kRadius) / kSlices;
  Real mass = 0, along = 0, across = 0;
  for (int i = 0; i < kSlices; ++i) {
    const Real z = (i + 0.5) * thickness - kLength / 2 - kRadius;
    const Real beyond = std::max<Real>(0, std::abs(z) - kLength / 2),
               r2 = kRadius * kRadius - beyond * beyond;
    const Real m = kDensity * kPi * r2 * thickness;
    mass += m, along += m * r2 / 2, across += m * (r2 / 4 + z * z);
  }
  const MassProperties capsule = solid_capsule(kDensity, kRadius, kLength);
  CHECK(near(capsule.mass, mass, {.relative = 1e-8}));
  CHECK(near(capsule.inertia.zz, along, {.relative = 1e-8}));
  CHECK(near(capsule.inertia.xx, across, {.relative = 1e-8}));
}

TEST_CASE("a dumb-bell: masses 2 and 1 at a distance of 3 along y") {
  const Sym3 none{1, 0, 0, 1, 0, 1};
  const MassProperties whole = composed({{2, {0, 0, 5}, none}, {1, {0, 3, 5}, none}});
  CHECK(whole.mass == 3);
  CHECK(norm(whole.center - Vec3{0, 1, 5}) < 1e-15);
  check_near(whole.inertia, {2 + 6, 0, 0, 2, 0, 2 + 6});
}

TEST_CASE("half a box is a box and its other half") {
  const MassProperties half = solid_box(2, {1, 2, 1.5});
  const MassProperties whole =
      composed({{half.mass, {0.3, 0, 0.75}, half.inertia}, {half.mass, {0.3, 0, -0.75}, half.inertia}});
  CHECK(norm(whole.center - Vec3{0.3, 0, 0}) < 1e-15);
  check_near(whole.inertia, {13, 0, 0, 10, 0, 5});
}

TEST_CASE("a rotated tensor") {
  // A quarter revolution about z takes x to y, and the products accordingly.
  const Mat3 quarter = rotation_matrix(exponential({0, 0, kPi / 2}));
  check_near(rotated_tensor(quarter, {1, 2, 3, 4, 5, 6}), {4, -2, -5, 1, 3, 6});
}

}  // namespace scree
