// Restitution and contact time against closed forms, and for n = 1.5 against quadrature and a fine
// Runge-Kutta.
#include <array>
#include <cmath>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/impacts.hpp"
#include "support/measured.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kStiffness = 1e6, kSpeed = 2, kMass = 1;  // [N/m^n], [m/s], [kg]

struct Impact {
  Real duration = 0, rebound = 0, largest_overlap = 0;  // [s], [m/s], [m]
};

// Where a line through (t - h, before) and (t, now) crosses zero.
Real crossing(Real t, Real h, Real before, Real now) { return t - h * now / (now - before); }

// An impact on the floor at y = -1. It ends with the overlap, or without tension with the force, whichever
// reaches zero first.
Impact floor_impact(Model model, Real expected_duration, int steps_in_contact) {
  const Real h = expected_duration / steps_in_contact, gap = 3.3 * h * kSpeed;
  model.particles.position[0] = {0, -0.95 + gap, 0};
  model.particles.velocity[0] = {0, -kSpeed, 0};
  model.time.step = model.time.max_step = h;
  model.time.end = 1.3 * expected_duration;
  const NormalLawParameters& law = model.contact.law(0, 0);
  const auto measure = [&](Real overlap, Real rate) {
    if (law.tension || overlap <= 0) return overlap;
    return law.normal_stiffness * std::pow(overlap, law.exponent) + law.normal_damping * rate;
  };
  SimulationRun run(model);
  Impact impact;
  Real before = 0;
  while (run.time() < model.time.end) {
    const Real step = run.step();
    const Particle particle = run.particles()[0];
    const Real overlap = -0.95 - particle.position.y, now = measure(overlap, -particle.velocity.y);
    if (before > 0 && now <= 0 && impact.duration == 0)
      impact.duration = crossing(run.time(), step, before, now) - gap / kSpeed;
    impact.largest_overlap = std::max(impact.largest_overlap, overlap);
    before = now;
  }
  impact.rebound = run.particles()[0].velocity.y;
  return impact;
}

std::vector<std::string> integrators() { return {"hht", "velocity-verlet"}; }

Model impact_model(Real damping, bool tension, Real exponent, const std::string& integrator) {
  return model_of(impact_deck(kStiffness, damping, tension, exponent),
                  {"integrator.particles=" + integrator, "time.step=1e-7"});
}

// Largest overlap and duration without damping, from the energy: v(d)^2 = v0^2 - 2 K d^(n+1) / (m (n + 1)).
// With d = D (1 - s^2) the integrand of the duration 2 int dd / v(d) is smooth where v = 0; Simpson's rule.
Impact energy_quadrature(Real n) {
  constexpr int kIntervals = 20000;
  Impact impact;
  impact.rebound = kSpeed;
  impact.largest_overlap = std::pow(kMass * kSpeed * kSpeed * (n + 1) / (2 * kStiffness), 1 / (n + 1));
  const auto integrand = [n](Real s) {
    if (s == 0) return 2 / std::sqrt(n + 1);
    return 2 * s / std::sqrt(1 - std::pow(1 - s * s, n + 1));
  };
  Real sum = integrand(0) + integrand(1);
  for (int k = 1; k < kIntervals; ++k) sum += (k % 2 ? 4 : 2) * integrand(Real(k) / kIntervals);
  impact.duration = 2 * impact.largest_overlap / kSpeed * sum / (3 * kIntervals);
  return impact;
}

// The impact by the classical Runge-Kutta method with steps of h [s] from touch on; with tension.
Impact runge_kutta(Real damping, Real n, Real h) {
  const auto acceleration = [&](Real d, Real v) {
    return -(kStiffness * std::pow(std::max(d, Real(0)), n) + damping * v) / kMass;
  };
  Impact impact;
  Real d = 0, v = kSpeed, t = 0, d_before = 0, v_before = v;
  do {
    d_before = d, v_before = v;
    const Real v1 = v, a1 = acceleration(d, v);
    const Real v2 = v + h / 2 * a1, a2 = acceleration(d + h / 2 * v1, v2);
    const Real v3 = v + h / 2 * a2, a3 = acceleration(d + h / 2 * v2, v3);
    const Real v4 = v + h * a3, a4 = acceleration(d + h * v3, v4);
    d += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4), v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4), t += h;
    impact.largest_overlap = std::max(impact.largest_overlap, d);
  } while (d > 0);
  const Real share = d_before / (d_before - d);
  impact.duration = t - h + h * share;
  impact.rebound = -(v_before + share * (v - v_before));
  return impact;
}

}  // namespace

TEST_CASE("restitution and contact time follow the closed forms") {
  constexpr Real kTruncation = 2e-4;  // first order at touch and release: C's jump over part of a step
  constexpr int kSteps = 20000;
  for (const Real ratio : {0.02, 0.05, 0.1, 0.2, 0.5}) {
    for (const bool tension : {true, false}) {
      for (const std::string& integrator : integrators()) {
        const ClosedImpact exact{ratio, std::sqrt(kStiffness / kMass), tension};
        const Real damping = 2 * ratio * std::sqrt(kStiffness * kMass);
        const Impact impact =
            floor_impact(impact_model(damping, tension, 1, integrator), exact.duration(), kSteps);
        CAPTURE(ratio, tension, integrator);
        CHECK(measured("restitution/rebound", "",
                       keeps(impact.rebound / (exact.restitution() * kSpeed) - 1,
                             {.promise = kTruncation, .measured = 2.5e-5})));
        CHECK(measured(
            "restitution/duration", "",
            keeps(impact.duration / exact.duration() - 1, {.promise = kTruncation, .measured = 8.3e-9})));
      }
    }
  }
}

TEST_CASE("the closed forms give known values") {
  const std::array<std::array<Real, 2>, 4> known = {
      {{0.05, 0.854468}, {0.1, 0.729248}, {0.2, 0.526621}, {0.5, 0.163034}}};
  for (const auto& [ratio, restitution] : known)
    CHECK(std::abs(ClosedImpact{ratio, 1, true}.restitution() - restitution) < 5e-7);
}

TEST_CASE("an undamped impact with n = 1.5 follows the energy integral") {
  constexpr Real kTruncation = 1e-6;  // (w h)^2 / 12 and the kink of the overlap's second derivative
  const Impact exact = energy_quadrature(1.5);
  for (const std::string& integrator : integrators()) {
    const Impact impact = floor_impact(impact_model(0, true, 1.5, integrator), exact.duration, 5000);
    CAPTURE(integrator);
    CHECK(
        measured("exponent/duration", "",
                 keeps(impact.duration / exact.duration - 1, {.promise = kTruncation, .measured = 4.6e-8})));
    CHECK(keeps(impact.rebound / kSpeed - 1, {.promise = kTruncation, .measured = 3.7e-9}));
    CHECK(measured("exponent/overlap", "",
                   keeps(impact.largest_overlap / exact.largest_overlap - 1,
                         {.promise = kTruncation, .measured = 5.9e-8})));
  }
}

TEST_CASE("a damped impact with n = 1.5 follows a fine Runge-Kutta integration") {
  constexpr Real kTruncation = 2e-4;  // first order at touch and release: C's jump over part of a step
  const Real undamped = energy_quadrature(1.5).duration;
  for (const Real damping : {20.0, 100.0}) {
    const Impact exact = runge_kutta(damping, 1.5, undamped / 200000);
    CHECK(exact.rebound < 0.97 * kSpeed);
    for (const std::string& integrator : integrators()) {
      const Impact impact = floor_impact(impact_model(damping, true, 1.5, integrator), exact.duration, 20000);
      CAPTURE(damping, integrator);
      CHECK(keeps(impact.duration / exact.duration - 1, {.promise = kTruncation, .measured = 2.7e-6}));
      CHECK(keeps(impact.rebound / exact.rebound - 1, {.promise = kTruncation, .measured = 1.5e-6}));
      CHECK(keeps(impact.largest_overlap / exact.largest_overlap - 1,
                  {.promise = kTruncation, .measured = 1.1e-5}));
    }
  }
}
