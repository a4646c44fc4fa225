// Rotation about z.
#include "base/rotation.hpp"

#include <numbers>

#include "support/catch.hpp"

namespace scree {

TEST_CASE("a rotation takes x to y, keeps lengths and z, and its inverse undoes it") {
  constexpr Real kRoundOff = 1e-15;
  const Vec3 quarter = Rotation(std::numbers::pi / 2).turn({2, 0, 3});
  CHECK((std::abs(quarter.x) < 2 * kRoundOff && std::abs(quarter.y - 2) < kRoundOff && quarter.z == 3));
  CHECK(Rotation().turn({2, -1, 3}) == Vec3{2, -1, 3});
  const Vec3 v{0.3, -1.7, 0.4}, back = Rotation(-0.7).turn(Rotation(0.7).turn(v));
  CHECK(norm(back - v) < 2 * kRoundOff);
  CHECK(std::abs(norm(Rotation(0.7).turn(v)) - norm(v)) < 2 * kRoundOff);
}

TEST_CASE("the rotational velocity is the derivative of the rotated vector") {
  constexpr Real kStep = 1e-5, kRate = 1.3, kTruncation = 1e-9;  // central difference: of order kStep^2
  const Vec3 s{0.3, -1.7, 0.4};
  const Vec3 difference =
      (1 / (2 * kStep)) * (Rotation(0.7 + kRate * kStep).turn(s) - Rotation(0.7 - kRate * kStep).turn(s));
  CHECK(norm(difference - rotational_velocity(kRate, Rotation(0.7).turn(s))) < kTruncation);
}

}  // namespace scree
