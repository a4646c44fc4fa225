// Steps of an orientation, against a known motion.
#include "physics/orientation.hpp"

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;

// Largest difference of the components, with the sign that has w >= 0.
Real difference(Quaternion a, const Quaternion& b) {
  if (a.w < 0) a = Real(-1) * a;
  return std::max({std::abs(a.w - b.w), std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

}  // namespace

TEST_CASE("a quaternion rotates vectors, and products rotate one after the other") {
  const Real half = std::sqrt(0.5);
  const Quaternion about_z{half, 0, 0, half}, about_x{half, half, 0, 0};  // by 90 degrees
  CHECK(near(rotated(about_z, {1, 0, 0}), Vec3{0, 1, 0}, {.absolute = kRoundOff}));
  CHECK(near(rotated(about_x * about_z, {1, 0, 0}), Vec3{0, 0, 1}, {.absolute = kRoundOff}));
  CHECK(rotated({}, {1, 2, 3}) == Vec3{1, 2, 3});
}

TEST_CASE("an orientation follows a rotating angular velocity to second order, at length 1") {
  const ReferenceTable table("contact/orientation.csv");
  for (const auto& row : table.rows()) {
    const Real b = row["b"], c = row["c"], t = row["t"];
    const Quaternion exact{row["qw"], row["qx"], row["qy"], row["qz"]};
    const auto error_after = [&](int steps) {
      Quaternion q;
      const Real h = t / steps;
      for (int k = 0; k < steps; ++k) {
        const Real angle = c * (k + 0.5) * h;
        q = rotated_by(q, {b * std::cos(angle), b * std::sin(angle), c}, h);
      }
      CHECK(near(dot(q, q), 1, {.absolute = kRoundOff}));
      return difference(q, exact);
    };
    CAPTURE(b, c, t);
    const int steps = 100 * static_cast<int>(std::ceil(t));
    const Real coarse = error_after(steps), fine = error_after(2 * steps);
    CHECK(coarse < 1e-3 * t * t);
    CHECK((coarse / fine > 3.9 && coarse / fine < 4.1));
  }
}

TEST_CASE("a million steps leave the length at 1") {
  Quaternion q;
  for (int k = 0; k < 1000000; ++k) q = rotated_by(q, {0.3, -1.1, 0.7}, 0.01);
  CHECK(near(dot(q, q), 1, {.absolute = kRoundOff}));
}

}  // namespace scree
