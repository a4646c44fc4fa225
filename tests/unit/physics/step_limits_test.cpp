// The step limits against the oscillators that they are made for.
#include "physics/step_limits.hpp"

#include <algorithm>
#include <numbers>

#include "physics/time_stepping.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;

// Largest |x| that velocity Verlet reaches from x = 1 on a damped oscillator, damping on the predicted
// velocity.
Real largest_swing(Real stiffness, Real damping, Real mass, Real h) {
  const auto acceleration = [&](Vec3 x, Vec3 v) { return (-1 / mass) * (stiffness * x + damping * v); };
  Vec3 x{1, 0, 0}, v, a = acceleration(x, v);
  Real largest = 1;
  for (int step = 0; step < 2000; ++step) {
    x += verlet_displacement(h, v, a);
    const Vec3 predicted = verlet_predicted_velocity(h, v, a);
    const Vec3 a1 = acceleration(x, predicted);
    v = verlet_velocity(h, predicted, a, a1), a = a1;
    largest = std::max(largest, std::abs(x.x));
  }
  return largest;
}

}  // namespace

TEST_CASE("velocity Verlet is stable below its limit and not above") {
  const Real stiffness = 1e4, mass = 0.5;
  const Real frequency = contact_frequency(stiffness, mass);
  for (const Real damping : {0.0, 5.0, 40.0, 200.0}) {
    CAPTURE(damping);
    const Real limit = verlet_step_limit(frequency, stiffness, damping);
    CHECK(largest_swing(stiffness, damping, mass, 0.99 * limit) < 10);
    CHECK(largest_swing(stiffness, damping, mass, 1.01 * limit) > 1e6);
  }
  CHECK(near(verlet_step_limit(frequency, stiffness, 0), 2 / frequency, {.relative = kRoundOff}));
}

TEST_CASE("contact time and typical stiffness") {
  CHECK(reduced_mass(2, 2) == 1);
  CHECK(near(reduced_mass(1, 1e12), 1 - 1e-12, {.relative = kRoundOff}));
  CHECK(near(contact_time(100, 1), std::numbers::pi / 10, {.relative = kRoundOff}));
  constexpr PairSize kSize{0.02, 0.01, 1, 1};
  CHECK(typical_stiffness({5e3, 0, 1, false}, kSize) == 5e3);
  CHECK(near(typical_stiffness({5e3, 0, 1.5, false}, kSize), 5e3 * 1.5 * 0.01, {.relative = kRoundOff}));
  CHECK(dense_frequency(6, 1, 2) == 6);
  CHECK(dense_frequency(2, 1, 3) == 4);
}

}  // namespace scree
