// Errors with steps of about a contact time: rebounds at any damping, alpha and exponent, and oblique
// impacts.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/impacts.hpp"
#include "support/measured.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kSpeed = 6.7, kRadius = 0.05, kMass = 1;  // [m/s], [m], [kg]

// An impact with K = 1e7 N/m, or a stiffness of the same order for other exponents.
struct Impact {
  Real ratio = 0;  // z = C / (2 sqrt(K m))
  Real exponent = 1;
  Real hht_alpha = 0;
  bool oblique = false;  // two discs in an impact at 45 degrees; else one on a wall
  ParticleIntegrator integrator = ParticleIntegrator::hht;
};

Real stiffness(const Impact& impact) { return impact.exponent == 1 ? 1e7 : 2e8; }

// Duration of the impact without damping [s]: 2 int dd / v(d) with v(d)^2 = v^2 - 2 K d^(n+1) / (m (n+1)).
Real contact_time(const Impact& impact) {
  const Real power = impact.exponent + 1, mass = impact.oblique ? kMass / 2 : kMass;
  const Real normal = impact.oblique ? kSpeed * std::sqrt(0.5) : kSpeed;
  const Real depth = std::pow(power * mass * normal * normal / (2 * stiffness(impact)), 1 / power);
  return 2 * depth / normal * std::sqrt(std::numbers::pi_v<Real>) * std::tgamma(1 + 1 / power) /
         std::tgamma(0.5 + 1 / power);
}

// The disc starts `gap` [m] before touch along its path.
Model impact_model(const Impact& impact, Real gap) {
  const Real damping = 2 * impact.ratio * std::sqrt(stiffness(impact) * kMass);
  const std::string deck = impact_deck(stiffness(impact), damping, true, impact.exponent);
  if (!impact.oblique) {
    Model model = model_of(deck);
    model.particles.position[0] = {0, -1 + kRadius + gap, 0};
    model.particles.velocity[0] = {0, -kSpeed, 0};
    return model;
  }
  Model model = model_of(deck, {"particles.disc.positions=[[-0.5, 0.0], [0.5, 0.0]]"});
  const Real along = kRadius * std::sqrt(0.5), across = along;
  model.particles.position[0] = {-along - gap / 2, across, 0};
  model.particles.position[1] = {along + gap / 2, -across, 0};
  model.particles.velocity[0] = {kSpeed / 2, 0, 0};
  model.particles.velocity[1] = {-kSpeed / 2, 0, 0};
  return model;
}

struct Outcome {
  Real error =
      0;  // of the rebound's speed, rms over the phases; oblique: fraction of the energy lost, their mean
  Real steps = 0;  // of a run, rejected ones included
};

// Phases of the impact within a step of h [s]; without h the steps are adaptive, at the default tolerance.
Outcome measure(const Impact& impact, std::optional<Real> h, int phases) {
  const Real touch = contact_time(impact), step = h.value_or(touch / 20);
  const ClosedImpact exact{impact.ratio, std::sqrt(stiffness(impact) / kMass), true};
  Outcome mean;
  for (int phase = 0; phase < phases; ++phase) {
    Model model = impact_model(impact, kSpeed * step * (1.5 + (phase + 0.5) / phases));
    model.integrator.hht_alpha = impact.hht_alpha;
    model.integrator.particles = impact.integrator;
    model.time.step = step;
    model.time.max_step = h ? step : 1e-2;
    if (!h) model.time.control = StepControl::adaptive;
    model.time.end = step * std::ceil(1.5 * touch / step + 6);
    SimulationRun run(model);
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);
    const std::vector<Particle> discs = run.particles();
    if (impact.oblique) {
      const Real kinetic =
          dot(discs[0].velocity, discs[0].velocity) + dot(discs[1].velocity, discs[1].velocity);
      mean.error += (1 - kinetic / (kSpeed * kSpeed / 2)) / phases;
    } else {
      const Real relative = discs[0].velocity.y / (exact.restitution() * kSpeed) - 1;
      mean.error += relative * relative / phases;
    }
    mean.steps += static_cast<Real>(run.counts().steps + run.counts().rejected_error) / phases;
  }
  if (!impact.oblique) mean.error = std::sqrt(mean.error);
  return mean;
}

constexpr std::array<Real, 4> kAlphas = {0, -0.05, -0.1, -0.3}, kRatios = {0.0016, 0.008, 0.063, 0.2};

// The impacts of the table: damped ones, another exponent, oblique ones.
std::vector<Impact> impacts(Real hht_alpha, ParticleIntegrator integrator = ParticleIntegrator::hht) {
  std::vector<Impact> all{{0, 1, hht_alpha, false, integrator}};
  for (const Real ratio : kRatios) all.push_back({ratio, 1, hht_alpha, false, integrator});
  all.push_back({0, 1.5, hht_alpha, false, integrator});
  all.push_back({0, 1, hht_alpha, true, integrator});
  return all;
}

std::string name(const Impact& impact) {
  const bool implicit = impact.integrator == ParticleIntegrator::hht;
  return fmt::format("{}, n = {}, z = {}, {}", impact.oblique ? "oblique, energy lost" : "rebound",
                     impact.exponent, impact.ratio,
                     implicit ? fmt::format("alpha = {}", impact.hht_alpha) : "velocity-verlet");
}

}  // namespace

TEST_CASE("a head-on impact with n = 1, no damping and alpha = 0 keeps its energy at any step") {
  constexpr Real kIteration = 1e-7;  // the residuals' tolerance of 1e-8, in every step of the contact
  const Impact impact;
  for (const Real share : {0.1, 0.3, 1.0, 3.0})
    CHECK(measure(impact, share * contact_time(impact), 40).error < kIteration);
}

TEST_CASE("steps of a tenth and a twentieth of the contact time keep any impact to the order of the method") {
  constexpr Real kTenth = 0.018, kTwentieth = 0.006;  // input/choosing.md, "Impacts at any step"
  for (const Real alpha : kAlphas) {
    for (const Impact& impact : impacts(alpha)) {
      const Real touch = contact_time(impact);
      CAPTURE(name(impact));
      CHECK(measured("any_step/tenth", "", at_most(measure(impact, touch / 10, 20).error, kTenth)));
      CHECK(measured("any_step/twentieth", "", at_most(measure(impact, touch / 20, 20).error, kTwentieth)));
    }
  }
}

TEST_CASE("explicit steps of a tenth and a twentieth of the contact time keep any impact to first order") {
  constexpr Real kTenth = 0.06, kTwentieth = 0.035;  // input/choosing.md, "Impacts at any step"
  for (const Impact& impact : impacts(0, ParticleIntegrator::velocity_verlet)) {
    const Real touch = contact_time(impact);
    CAPTURE(name(impact));
    CHECK(measured("any_step/explicit tenth", "", at_most(measure(impact, touch / 10, 100).error, kTenth)));
    CHECK(measured("any_step/explicit twentieth", "",
                   at_most(measure(impact, touch / 20, 100).error, kTwentieth)));
  }
}

TEST_CASE("adaptive steps keep any impact") {
  constexpr Real kPhysical = 2e-4;  // input/choosing.md, "Impacts at any step"
  for (const Real alpha : kAlphas) {
    for (const Impact& impact : impacts(alpha)) {
      CAPTURE(name(impact));
      CHECK(measured("any_step/adaptive", "", at_most(measure(impact, {}, 8).error, kPhysical)));
    }
  }
}

// The errors stated in input/choosing.md for coarse steps are the measured ones.
TEST_CASE("steps of about a contact time have the errors stated in input/choosing.md") {
  constexpr Real kDigits = 0.05;  // of two digits, and of another number of phases
  struct Claim {
    Impact impact;
    Real share, error;  // step over contact time
  };
  const std::array<Claim, 11> claims = {{{{0.0016, 1, 0}, 1, 0.0019},
                                         {{0.008, 1, 0}, 1, 0.0097},
                                         {{0.063, 1, 0}, 1, 0.080},
                                         {{0.2, 1, 0}, 1, 0.29},
                                         {{0, 1, -0.05}, 1, 0.035},
                                         {{0, 1, -0.3}, 1, 0.088},
                                         {{0, 1.5, 0}, 0.3, 0.021},
                                         {{0, 1.5, 0}, 1, 0.023},
                                         {{0, 1, 0, true}, 0.3, 0.00070},
                                         {{0, 1, 0, true}, 1, 0.019},
                                         {{0, 1, 0, true}, 3, 0.21}}};
  for (const Claim& claim : claims) {
    const Outcome found = measure(claim.impact, claim.share * contact_time(claim.impact), 100);
    CAPTURE(name(claim.impact), claim.share, found.error);
    CHECK(std::abs(found.error / claim.error - 1) < kDigits);
  }
}

// The table of input/choosing.md: test_verification_impact "[table]", with SCREE_MEASURED.
TEST_CASE("the table of impacts at any step", "[.][table]") {
  constexpr int kPhases = 100;
  std::vector<Impact> all;
  for (const Real alpha : kAlphas)
    for (const Impact& impact : impacts(alpha)) all.push_back(impact);
  for (const Impact& impact : impacts(0, ParticleIntegrator::velocity_verlet)) all.push_back(impact);
  std::cout << "| impact | h = T/20 | T/10 | 0.3 T | T | 3 T | adaptive (steps) |\n";
  for (const Impact& impact : all) {
    const bool implicit = impact.integrator == ParticleIntegrator::hht;
    std::cout << "| " << name(impact) << " |";
    for (const Real share : {0.05, 0.1, 0.3, 1.0, 3.0}) {
      const bool stable = implicit || share < 0.5;
      if (stable) {
        const Outcome found = measure(impact, share * contact_time(impact), kPhases);
        note("impact_table/" + name(impact) + fmt::format("/{} T", share), "", std::abs(found.error));
        std::cout << fmt::format(" {:.2g} % |", 100 * found.error);
      } else {
        std::cout << " |";
      }
    }
    if (implicit) {
      const Outcome adaptive = measure(impact, {}, kPhases);
      note("impact_table/" + name(impact) + "/adaptive", "", std::abs(adaptive.error));
      note("impact_table/" + name(impact) + "/steps", "", std::round(adaptive.steps));
      std::cout << fmt::format(" {:.2g} % ({:.0f}) |", 100 * adaptive.error, adaptive.steps);
    }
    std::cout << std::endl;
  }
}

// For the same table: errors of impacts add up.
TEST_CASE("energy gain of an undamped gas in 1,000 steps of a third of the contact time", "[.][table]") {
  for (const auto& [exponent, stiffness] : {std::pair{"1.0", "2.5e4"}, std::pair{"1.5", "1.1e6"}}) {
    for (const std::string alpha : {"0.0", "-0.05"}) {
      const Model model = input_model(
          "examples/gas_periodic.toml",
          {"integrator.particles=hht", "time.control=fixed", "time.step=4.792e-4", "time.end=0.4792",
           "particles.gas.count=1000", "integrator.hht_alpha=" + alpha,
           std::string("contact.pairs.0.exponent=") + exponent,
           std::string("contact.pairs.0.stiffness=") + stiffness, "output.history_interval=0.04792"});
      SimulationRun run(model);
      const Real start = run.ledger().mechanical();
      run.run();
      const Real gain = run.ledger().mechanical() / start - 1;
      note("impact_table/" + fmt::format("gas, n = {}, alpha = {}", exponent, alpha), "", gain);
      std::cout << fmt::format("gas, n = {}, alpha = {}: {:+.2g} % of its energy\n", exponent, alpha,
                               100 * gain);
    }
  }
}
