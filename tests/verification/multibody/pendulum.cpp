// Pendulums: the period of large oscillations, and a double pendulum against a Runge-Kutta solution in
// minimal coordinates.
#include <array>
#include <cmath>

#include "support/catch.hpp"
#include "support/multibody_run.hpp"

using namespace scree;

namespace {

// The paper's disc on a revolute joint 0.5 m from its centre, released at 90 degrees.
Model pendulum(Real hht_alpha) {
  Model model = empty_model();
  model.integrator.hht_alpha = hht_alpha;
  model.bodies.push_back(paper_disc("bob", 0.5, 0));
  model.joints.push_back(ground_pin("pivot", 0, {0, 0, 0}, {-0.5, 0, 0}));
  return model;
}

// Root in [0, h] of the cubic with values f0, f1 and slopes d0, d1 at its ends, by bisection.
Real hermite_root(Real h, Real f0, Real d0, Real f1, Real d1) {
  const auto value = [&](Real s) {
    const Real a = 1 - s;
    return a * a * (1 + 2 * s) * f0 + s * a * a * h * d0 + s * s * (1 + 2 * a) * f1 - s * s * a * h * d1;
  };
  Real low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const Real middle = (low + high) / 2;
    ((value(middle) > 0) == (f0 > 0) ? low : high) = middle;
  }
  return low * h;
}

// Time from one downward passage of the lowest point to the next one, T.
Real period(Real hht_alpha, Real h) {
  MultibodyRun run(pendulum(hht_alpha));
  std::vector<Real> passages;
  while (passages.size() < 2) {
    const Real before = run.angle(0) + M_PI / 2, rate = run.state.velocity[2], start = run.time;
    run.step(h);
    run.time = start + h;
    const Real after = run.angle(0) + M_PI / 2;
    if (before > 0 && after <= 0) {
      passages.push_back(start + hermite_root(h, before, rate, after, run.state.velocity[2]));
    }
  }
  return passages[1] - passages[0];
}

// Two rods of masses m_i and inertias I_i about their centres, which are a_i from the upper joint; the first
// rod is length long. Angles from the downward vertical. Lagrange's equations of the minimal coordinates.
struct DoublePendulum {
  Real m1 = 1.3, m2 = 0.7, i1 = 0.02, i2 = 0.01, a1 = 0.25, a2 = 0.2, length = 0.5;

  using State = std::array<Real, 4>;  // angles, rates

  State rate(const State& s) const {
    const Real c = m2 * length * a2 * std::cos(s[0] - s[1]), d = m2 * length * a2 * std::sin(s[0] - s[1]);
    const Real m11 = i1 + m1 * a1 * a1 + m2 * length * length, m22 = i2 + m2 * a2 * a2;
    const Real f1 = -d * s[3] * s[3] - kGravity * (m1 * a1 + m2 * length) * std::sin(s[0]);
    const Real f2 = d * s[2] * s[2] - kGravity * m2 * a2 * std::sin(s[1]);
    const Real determinant = m11 * m22 - c * c;
    return {s[2], s[3], (m22 * f1 - c * f2) / determinant, (m11 * f2 - c * f1) / determinant};
  }

  State step(const State& s, Real h) const {
    const auto moved = [&](const State& k, Real factor) {
      State result = s;
      for (std::size_t i = 0; i < 4; ++i) result[i] += factor * k[i];
      return result;
    };
    const State k1 = rate(s), k2 = rate(moved(k1, h / 2)), k3 = rate(moved(k2, h / 2)),
                k4 = rate(moved(k3, h));
    State next = s;
    for (std::size_t i = 0; i < 4; ++i) next[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return next;
  }
};

constexpr Real kAngle1 = 1.9, kAngle2 = 0.6;  // at the start, at rest

Model double_pendulum(const DoublePendulum& rods, Real hht_alpha) {
  Model model = empty_model();
  model.integrator.hht_alpha = hht_alpha;
  const Vec3 along1{std::sin(kAngle1), -std::cos(kAngle1), 0},
      along2{std::sin(kAngle2), -std::cos(kAngle2), 0};
  Body upper, lower;
  upper.name = "upper", lower.name = "lower";
  upper.mass = rods.m1, lower.mass = rods.m2;
  upper.inertia = rods.i1, lower.inertia = rods.i2;
  upper.position = rods.a1 * along1;
  lower.position = rods.length * along1 + rods.a2 * along2;
  // The rods lie along their bodies' x axes.
  upper.angle = kAngle1 - M_PI / 2, lower.angle = kAngle2 - M_PI / 2;
  model.bodies = {upper, lower};
  model.joints.push_back(ground_pin("pivot", 0, {0, 0, 0}, {-rods.a1, 0, 0}));
  model.joints.push_back(ground_pin("elbow", 1, {rods.length - rods.a1, 0, 0}, {-rods.a2, 0, 0}));
  model.joints[1].body[0] = 0;
  return model;
}

// Largest error of both angles over one second, before small differences grow.
Real double_pendulum_error(Real hht_alpha, Real h) {
  const DoublePendulum rods;
  MultibodyRun run(double_pendulum(rods, hht_alpha));
  DoublePendulum::State exact{kAngle1, kAngle2, 0, 0};
  const int samples = 200, steps = static_cast<int>(std::lround(1 / (samples * h)));
  Real largest = 0;
  for (int sample = 0; sample < samples; ++sample) {
    run.steps(steps, h);
    for (int i = 0; i < 200; ++i) exact = rods.step(exact, 1.0 / (samples * 200));
    for (const int body : {0, 1}) {
      const Real angle = run.angle(body) + M_PI / 2;
      largest = std::max(largest, std::abs(angle - exact[static_cast<std::size_t>(body)]));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("the pendulum's period converges to the closed form with second order") {
  const Real exact = 1.69127048986131;  // elliptic integral, 90 degrees
  for (const Real hht_alpha : {0.0, -0.1, -0.3}) {
    const Real coarse = period(hht_alpha, 2e-3) - exact, fine = period(hht_alpha, 1e-3) - exact;
    CAPTURE(hht_alpha, coarse, fine);
    CHECK(std::abs(fine) < 2e-5);
    CHECK(std::log2(coarse / fine) > 1.95);
    CHECK(std::log2(coarse / fine) < 2.05);
  }
}

TEST_CASE("the double pendulum converges to the minimal-coordinate solution with second order") {
  for (const Real hht_alpha : {-0.05, -0.3}) {
    const Real coarse = double_pendulum_error(hht_alpha, 1e-3), fine = double_pendulum_error(hht_alpha, 5e-4);
    CAPTURE(hht_alpha, coarse, fine);
    CHECK(fine < 1e-4);
    CHECK(std::log2(coarse / fine) > 1.95);
    CHECK(std::log2(coarse / fine) < 2.05);
  }
}
