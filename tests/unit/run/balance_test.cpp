// The reference of energy errors, and warnings of energy errors of the time integration.
#include "run/report/balance.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

// 1 kJ was exchanged, of which the integrator takes `taken` and the ledger lacks `missed` [J].
BalanceState balance_of(Real taken, Real missed) {
  BalanceState balance;
  balance.open = true, balance.start = 5003, balance.start_integrator = 3, balance.exchanged = 1000;
  balance.last.kinetic = 5000 - taken + missed, balance.last.dissipated_integrator = taken + 3;
  return balance;
}

Model model_with(ParticleIntegrator particles, StepControl control) {
  Model model;
  model.integrator.particles = particles, model.time.control = control;
  return model;
}

// Energy is transferred between the entries of these ledgers.
Ledger moving(Real kinetic) {
  Ledger ledger;
  ledger.kinetic = kinetic;
  return ledger;
}

}  // namespace

TEST_CASE("a run warns of more than 1 % of the energy exchanged, taken or given, accounted for or not") {
  const Model hht = model_with(ParticleIntegrator::hht, StepControl::fixed);
  for (const Real sign : {1, -1}) {
    CHECK(balance_warning(balance_of(sign * 9.9, 0), {}, hht).empty());
    CHECK(balance_warning(balance_of(0, sign * 9.9), {}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(sign * 10.1, 0), {}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(0, sign * 10.1), {}, hht).empty());
  }
}

TEST_CASE("losses of bodies that exchange little count from 1 % of their energy on") {
  const Model hht = model_with(ParticleIntegrator::hht, StepControl::fixed);
  for (const Real sign : {1, -1}) {
    CHECK(balance_warning(balance_of(sign * 49, 0), {5000, sign * 49, 0}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(sign * 51, 0), {5000, sign * 51, 0}, hht).empty());
    // Losses of particles do not count as the bodies', whatever energy these have; nor does a missing
    // energy.
    CHECK_FALSE(balance_warning(balance_of(sign * 49, 0), {5000, sign * 38, 0}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(0, sign * 11), {5000, 0, 0}, hht).empty());
    // Each changes little alone, one of them more together.
    CHECK(balance_warning(balance_of(0, 0), {5000, sign * 49, 0}, hht).empty());
  }
}

TEST_CASE("in explicit steps the particles' entry of the integrator is a function of state, and no loss") {
  const Model verlet = model_with(ParticleIntegrator::velocity_verlet, StepControl::fixed);
  CHECK(balance_warning(balance_of(400, 0), {}, verlet).empty());
  CHECK_FALSE(balance_warning(balance_of(0, 11), {}, verlet).empty());
  CHECK_FALSE(balance_warning(balance_of(51, 0), {5000, 51, 0}, verlet).empty());  // bodies' steps are HHT's
}

TEST_CASE("the warning has the amount, its reference, and the remedy for the run") {
  const auto text = [](ParticleIntegrator particles, StepControl control, Real taken, Real missed) {
    return balance_warning(balance_of(taken, missed), {}, model_with(particles, control));
  };
  const std::string hht = text(ParticleIntegrator::hht, StepControl::fixed, -480, 0.5);
  CAPTURE(hht);
  CHECK(contains(hht, "by 480 J, 48 % of the 1000 J exchanged"));
  CHECK(contains(hht, "took out -480 J, and 0.5 J are not accounted for"));
  CHECK(contains(hht, "shorten time.step, or set time.control = \"adaptive\""));
  const std::string adaptive = text(ParticleIntegrator::hht, StepControl::adaptive, 20, 0);
  CHECK((contains(adaptive, "time.tolerance") && !contains(adaptive, "time.step")));
  const std::string verlet = text(ParticleIntegrator::velocity_verlet, StepControl::fixed, 0, 20);
  CHECK((contains(verlet, ": shorten time.step") && !contains(verlet, "substeps")));
  CHECK(!contains(verlet, "adaptive"));
}

TEST_CASE("explicit steps with accurate impacts are distinguished from steps that are too long") {
  const std::string deck = kSmallDeck + R"(
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
damping = 5.0
[[particles]]
kind = "list"
positions = [[-0.3, 0.0], [0.3, 0.0]]
radius = 0.1
mass = 1.0
)";
  BalanceState balance = balance_of(0, 20);
  const auto text = [&](const std::string& step) {
    return balance_warning(balance, {}, model_of(deck, {"time.step=" + step}));
  };
  balance.last.kinetic -= 300, balance.last.dissipated_contacts = 300;
  const std::string fine = text("1e-4"), coarse = text("4e-3");
  CAPTURE(fine, coarse);
  CHECK(contains(fine, "20 J, 2 % of the 1000 J exchanged, are not accounted for"));
  CHECK(contains(fine, "of the dissipation of contacts, 300 J here, explicit steps integrate"));
  CHECK(!contains(fine, "has changed the energy"));
  CHECK(contains(coarse, "has changed the energy by 20 J, 2 % of the 1000 J exchanged"));
  CHECK(contains(coarse, "shorten time.step: in these steps the energy of impacts is off by up to "));
  balance.last.kinetic += 300, balance.last.dissipated_contacts = 0;  // nothing to account for
  CHECK(contains(text("1e-4"), "has changed the energy"));
}

TEST_CASE("where next to nothing was exchanged the last bits of the energies are no reason to warn") {
  const Model hht = model_with(ParticleIntegrator::hht, StepControl::fixed);
  BalanceState balance = balance_of(0, 0);
  balance.exchanged = 1e-9, balance.last.kinetic += 1e-9;
  CHECK(balance_warning(balance, {}, hht).empty());
  // Energies of 1e-20 J, of bodies whose forces have a scale of 1 J.
  balance = BalanceState{true, 0, 0, 1e-20, 0, {}, moving(4e-21)};
  CHECK(balance_warning(balance, {0, 0, 1e-9}, hht).empty());
  CHECK_FALSE(balance_warning(balance, {0, 0, 1e-21}, hht).empty());
}

TEST_CASE("particles of some weight far from the origin have coarse energies") {
  Model model = model_with(ParticleIntegrator::hht, StepControl::fixed);
  model.particles.totals.count = 100, model.particles.totals.largest_mass = 1, model.gravity = {0, 0, -10};
  const BalanceState balance{true, 0, 0, 1e-8, 0, {}, moving(2e-9)};
  model.space.min = {0, 0, 0}, model.space.max = {1, 1, 1};
  CHECK_FALSE(balance_warning(balance, {}, model).empty());
  model.space.max = {1, 1, 1e6};
  CHECK(balance_warning(balance, {}, model).empty());
}

TEST_CASE("before the first step nothing was exchanged, and there is no warning") {
  Ledger start;
  start.dissipated_integrator = -0.25;  // of velocity-Verlet: a function of state
  for (const ParticleIntegrator particles : {ParticleIntegrator::hht, ParticleIntegrator::velocity_verlet}) {
    BalanceState balance;
    add_row(balance, start, {}, {});
    CHECK((balance.exchanged == 0 && balance_error(balance) == 0 && taken_by_integrator(balance) == 0));
    CHECK(balance_warning(balance, {}, model_with(particles, StepControl::fixed)).empty());
  }
}

TEST_CASE(
    "the energy exchanged is that of particles, ranges of bodies, springs and work, and what was lost") {
  BalanceState balance;
  MultibodyState bodies;
  bodies.min_kinetic = 5000, bodies.max_kinetic = 5000.5;  // of a flywheel
  Ledger ledger;
  ledger.gravitational = -1e9;
  add_row(balance, ledger, extremes_at(2, 100, bodies), bodies);
  CHECK(balance.exchanged == 2.5);
  bodies.driver_work = -6;
  add_sample(balance, extremes_at(9, 98, bodies));
  bodies.driver_work = 1;
  ledger.gravitational = 1e9, ledger.carried_out = 1e9;
  ledger.dissipated_force_elements = 0.25, ledger.dissipated_contacts = 0.125;
  for (const Real kinetic : {16, 3}) {  // rows leave no trace
    add_row(balance, ledger, extremes_at(kinetic, 104, bodies), bodies);
    CHECK(balance.exchanged == std::max(kinetic, Real(9)) + 0.5 + 6 + 7 + 0.375);
  }
}

TEST_CASE("rows of the history do not change what was exchanged") {
  const std::vector<Real> kinetic = {1, 4, 9, 2, 8, 3, 5};
  std::set<Real> exchanged;
  for (const std::size_t every : {1, 2, 3, 6}) {
    BalanceState balance;
    for (std::size_t k = 0; k < kinetic.size(); ++k) {
      if (k > 0 && k % 2 == 0) add_sample(balance, extremes_at(kinetic[k], 0, {}));
      if (k % every == 0) add_row(balance, {}, extremes_at(kinetic[k], 0, {}), {});
    }
    exchanged.insert(balance.exchanged);
  }
  CHECK(exchanged == std::set<Real>{9});
}

TEST_CASE("with another deck the balance continues from its last row, and the energy exchanged stays") {
  BalanceState balance;
  const auto row = [&](Real kinetic) { add_row(balance, moving(kinetic), extremes_at(kinetic, 0, {}), {}); };
  row(40), row(39);
  rebase(balance, moving(78), extremes_at(78, 0, {}));  // twice the masses
  CHECK((balance_error(balance) == -1 && balance.exchanged == 40));
  row(30);
  CHECK((balance_error(balance) == -49 && balance.exchanged == 78));
}

TEST_CASE("the energies are sampled after numbers of steps that follow from the steps before alone") {
  for (const bool implicit : {true, false}) {
    std::vector<std::int64_t> samples;
    for (std::int64_t steps = 0; steps < 100000; steps = samples.back())
      samples.push_back(next_energy_sample(steps, implicit));
    CHECK(samples.front() == (implicit ? 4 : 128));
    CHECK(samples.back() - samples[samples.size() - 2] == (implicit ? 8 : 1024));
    for (std::size_t k = 1, wrong = 0; k < samples.size(); ++k) {  // whichever sample is wrong
      for (const std::int64_t from : {samples[k - 1], (samples[k - 1] + samples[k]) / 2, samples[k] - 1})
        wrong += next_energy_sample(from, implicit) != samples[k];
      if (k + 1 == samples.size()) CHECK(wrong == 0);
    }
  }
}

}  // namespace scree
