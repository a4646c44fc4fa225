// Coefficients and identities of HHT, Newmark and velocity Verlet.
#include "physics/time_stepping.hpp"

#include "physics/energy.hpp"
#include "physics/time_function.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;
constexpr Within kVectors{.relative = kRoundOff, .absolute = kRoundOff};
constexpr Real kTruncation = 1e-9;  // of central differences over 1e-5, and their round-off
constexpr Real kAlphas[] = {0, -0.05, -0.1, -0.3, -1.0 / 3};
const Vec3 kVelocity{1, -2, 0.5}, kStart{3, 1, -4}, kEnd{-2, 5, 1};
constexpr Real kStep = 0.1, kMass = 2.5;

}  // namespace

TEST_CASE("HHT's coefficients") {
  const HhtCoefficients trapezoidal = hht_coefficients(0);
  CHECK(trapezoidal.newmark_gamma == 0.5);
  CHECK(trapezoidal.newmark_beta == 0.25);
  CHECK(near(trapezoidal.error_constant, 1.0 / 12, {.relative = kRoundOff}));
  const HhtCoefficients most_damped = hht_coefficients(-1.0 / 3);
  CHECK(near(most_damped.newmark_gamma, 5.0 / 6, {.relative = kRoundOff}));
  CHECK(near(most_damped.newmark_beta, 4.0 / 9, {.relative = kRoundOff}));
  for (const Real alpha : kAlphas) {
    const HhtCoefficients c = hht_coefficients(alpha);
    CAPTURE(alpha);
    CHECK(c.hht_alpha == alpha);
    CHECK(near(c.newmark_gamma, 0.5 - alpha, {.relative = kRoundOff}));  // second order
    CHECK(c.error_constant > 0);
  }
}

TEST_CASE("Newmark is exact for a constant acceleration and a mean for a changing one") {
  for (const Real alpha : kAlphas) {
    CAPTURE(alpha);
    const HhtCoefficients c = hht_coefficients(alpha);
    const Real h = kStep;
    CHECK(near(newmark_displacement(c, h, kVelocity, kStart, kStart), h * kVelocity + (h * h / 2) * kStart,
               kVectors));
    CHECK(near(newmark_velocity(c, h, kVelocity, kStart, kStart), kVelocity + h * kStart, kVectors));
    const Vec3 dx = newmark_displacement(c, h, kVelocity, kStart, kEnd);
    CHECK(near(dx, h * kVelocity + (h * h) * ((0.5 - c.newmark_beta) * kStart + c.newmark_beta * kEnd),
               kVectors));
    CHECK(newmark_displacement(c, h, kVelocity.x, kStart.x, kEnd.x) == dx.x);  // the scalar version agrees
  }
}

TEST_CASE("Newmark's gains are the changes of position and velocity per change of the acceleration") {
  for (const Real alpha : kAlphas) {
    CAPTURE(alpha);
    const HhtCoefficients c = hht_coefficients(alpha);
    const Real h = kStep;
    const Vec3 dx = newmark_displacement(c, h, kVelocity, kStart, kEnd);
    const Vec3 v = newmark_velocity(c, h, kVelocity, kStart, kEnd);
    const Vec3 other = kEnd + kStart;
    CHECK(near(newmark_displacement(c, h, kVelocity, kStart, other),
               dx + newmark_position_gain(c, h) * kStart, kVectors));
    CHECK(near(newmark_velocity(c, h, kVelocity, kStart, other), v + newmark_velocity_gain(c, h) * kStart,
               kVectors));
  }
}

TEST_CASE("without numerical damping, Newmark is the trapezoidal rule") {
  const HhtCoefficients c = hht_coefficients(0);
  const Vec3 v1 = newmark_velocity(c, kStep, kVelocity, kStart, kEnd);
  CHECK(near(newmark_displacement(c, kStep, kVelocity, kStart, kEnd), (kStep / 2) * (kVelocity + v1),
             kVectors));
}

TEST_CASE("HHT's residual vanishes for forces that fit the accelerations") {
  const Vec3 f0{10, 20, -30}, f1{-5, 8, 2};
  for (const Real alpha : kAlphas) {
    CAPTURE(alpha);
    const HhtCoefficients c = hht_coefficients(alpha);
    const Vec3 a1 = (1 / kMass) * ((1 + alpha) * f1 - alpha * f0);
    CHECK(norm(hht_residual(c, kMass, a1, f1, f0)) <= kRoundOff * norm(f1));
    // The acceleration after an event is consistent with the force there.
    const Vec3 f2{1, 2, 3};
    const Vec3 after = a1 + hht_event_acceleration(c, kMass, f1, f2);
    CHECK(norm(hht_residual(c, kMass, after, f2, f0)) <= kRoundOff * norm(f0));
  }
}

TEST_CASE("the integrator takes nothing out without numerical damping") {
  const HhtCoefficients c = hht_coefficients(0);
  const Vec3 dx = newmark_displacement(c, kStep, kVelocity, kStart, kEnd);
  const Vec3 v1 = newmark_velocity(c, kStep, kVelocity, kStart, kEnd);
  const Real loss = integrator_loss(kMass, dx, kVelocity, v1, kMass * kStart, kMass * kEnd);
  CHECK(std::abs(loss) <= kRoundOff * kinetic_energy(kMass, kVelocity));
}

// One particle on a spring, many steps: the loss accounted for is the missing energy.
TEST_CASE("the integrator's loss is the energy that an oscillator misses") {
  const Real stiffness = 400, h = 0.02;
  for (const Real alpha : kAlphas) {
    CAPTURE(alpha);
    const HhtCoefficients c = hht_coefficients(alpha);
    Vec3 x{1, 0, 0}, v, f = -stiffness * x, a = (1 / kMass) * f;
    Real lost = 0;
    const auto energy = [&] { return kinetic_energy(kMass, v) + stiffness / 2 * dot(x, x); };
    const Real start = energy();
    for (int step = 0; step < 100; ++step) {
      // M a1 / (1 + alpha) + k (x + dx(a1)) + alpha / (1 + alpha) f0 = 0, linear in a1.
      const Real scale = 1 / (1 + alpha);
      const Vec3 known = x + newmark_displacement(c, h, v, a, Vec3{});
      const Vec3 a1 = (-1 / (kMass * scale + stiffness * c.newmark_beta * h * h)) *
                      (stiffness * known + (alpha * scale) * f);
      const Vec3 dx = newmark_displacement(c, h, v, a, a1), v1 = newmark_velocity(c, h, v, a, a1);
      const Vec3 f1 = -stiffness * (x + dx);
      CHECK(norm(hht_residual(c, kMass, a1, f1, f)) <= 1e-12 * stiffness);
      lost += integrator_loss(kMass, dx, v, v1, f, f1);
      x += dx, v = v1, a = a1, f = f1;
    }
    CHECK(near(start - energy(), lost, {.absolute = 25 * kUlp * start}));
    CHECK(lost >= -1e-12 * start);
    CHECK((lost > 1e-6 * start) == (alpha < 0));
  }
}

TEST_CASE("velocity Verlet: the velocity changes by the mean acceleration over the step") {
  const Vec3 predicted = verlet_predicted_velocity(kStep, kVelocity, kStart);
  CHECK(near(verlet_velocity(kStep, predicted, kStart, kEnd), kVelocity + (kStep / 2) * (kStart + kEnd),
             kVectors));
}

TEST_CASE("velocity Verlet runs backwards on its own path") {
  const Vec3 dx = verlet_displacement(kStep, kVelocity, kStart);
  const Vec3 v1 = verlet_velocity(kStep, verlet_predicted_velocity(kStep, kVelocity, kStart), kStart, kEnd);
  CHECK(near(verlet_displacement(-kStep, v1, kEnd), -dx, kVectors));
  CHECK(near(verlet_velocity(-kStep, verlet_predicted_velocity(-kStep, v1, kEnd), kEnd, kStart), kVelocity,
             kVectors));
}

TEST_CASE("velocity Verlet's energy error is the change of the shift") {
  const Vec3 dx = verlet_displacement(kStep, kVelocity, kStart);
  const Vec3 v1 = verlet_velocity(kStep, verlet_predicted_velocity(kStep, kVelocity, kStart), kStart, kEnd);
  const Real error = integrator_loss(kMass, dx, kVelocity, v1, kMass * kStart, kMass * kEnd);
  const Real shift = verlet_energy_shift(kStep, kMass, kStart) - verlet_energy_shift(kStep, kMass, kEnd);
  CHECK(near(error, shift, {.relative = 8 * kRoundOff}));
}

// x = t^3 / 6 with HHT's accelerations a_n = t_n + alpha h: the error of one step is the estimate.
TEST_CASE("the error estimate is the local error of a steady jerk") {
  const Real h = 0.01;
  for (const Real alpha : kAlphas) {
    CAPTURE(alpha);
    const HhtCoefficients c = hht_coefficients(alpha);
    const Vec3 a0{alpha * h, 0, 0}, a1{h + alpha * h, 0, 0};
    const Real error = newmark_displacement(c, h, Vec3{}, a0, a1).x - h * h * h / 6;
    CHECK(near(hht_position_error(c, h, a0, a1, 1), error, {.relative = 4 * kRoundOff}));
    CHECK(near(hht_position_error(c, h, a0, a1, 0.5), 2 * error, {.relative = 4 * kRoundOff}));
  }
}

TEST_CASE("time functions: rates and accelerations are derivatives") {
  const SplineSegment segment{1, 3, 2, -1, 0.7, -0.4};
  const auto check = [](const auto& function, Real t) {
    const Real dt = 1e-5;
    const TimeValue up = function(t + dt), down = function(t - dt), at = function(t);
    CHECK(near(at.rate, (up.value - down.value) / (2 * dt),
               {.relative = kTruncation, .absolute = kTruncation}));
    CHECK(near(at.acceleration, (up.rate - down.rate) / (2 * dt),
               {.relative = kTruncation, .absolute = kTruncation}));
  };
  check([](Real t) { return ramp_function(2, -3, t); }, 1.5);
  check([](Real t) { return sine_function(1, 0.5, 0.7, 0.3, t); }, 1.5);
  check([&](Real t) { return spline_function(segment, t); }, 1.5);
  CHECK(spline_function(segment, 1).value == 2);
  CHECK(spline_function(segment, 3).value == -1);
  CHECK(spline_function(segment, 1).acceleration == 0.7);
  CHECK(spline_function(segment, 3).acceleration == -0.4);
}

TEST_CASE("many Verlet steps under a constant acceleration are taken at once") {
  Vec3 middle = kVelocity, displacement;
  constexpr int kSteps = 37;
  for (int step = 0; step < kSteps; ++step) {
    middle = verlet_next_middle(kStep, middle, kStart);
    displacement += kStep * middle;
  }
  CHECK(near(verlet_middle_after(kSteps, kStep, kVelocity, kStart), middle, kVectors));
  CHECK(near(verlet_displacement_of(kSteps, kStep, kVelocity, kStart), displacement, kVectors));
}

}  // namespace scree
