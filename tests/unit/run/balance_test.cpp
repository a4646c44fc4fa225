// When a run warns of what the time integration did to the energy, and of what.
#include "run/balance.hpp"

#include "support/catch.hpp"

namespace scree {

namespace {

// 1 kJ moves about, of which the integrator takes `taken` and the ledger misses `missed` [J].
BalanceState balance_of(Real taken, Real missed) {
  BalanceState balance;
  balance.open = true, balance.start = 5000, balance.exchanged = 1000;
  balance.last.kinetic = 5000 - taken + missed, balance.last.dissipated_integrator = taken;
  return balance;
}

Model model_with(ParticleIntegrator particles, StepControl control) {
  Model model;
  model.integrator.particles = particles, model.time.control = control;
  return model;
}

}  // namespace

TEST_CASE("a run warns of more than 1 % of the energy exchanged, taken or given, booked or not") {
  const Model hht = model_with(ParticleIntegrator::hht, StepControl::fixed);
  for (const Real sign : {1, -1}) {
    CHECK(balance_warning(balance_of(sign * 9.9, 0), {}, hht).empty());
    CHECK(balance_warning(balance_of(0, sign * 9.9), {}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(sign * 10.1, 0), {}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(0, sign * 10.1), {}, hht).empty());
  }
}

TEST_CASE("what was taken out of bodies that exchange little counts from 1 % of what they hold on") {
  const Model hht = model_with(ParticleIntegrator::hht, StepControl::fixed);
  for (const Real sign : {1, -1}) {
    CHECK(balance_warning(balance_of(sign * 49, 0), {5000, sign * 49}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(sign * 51, 0), {5000, sign * 51}, hht).empty());
    // What particles lost is not the bodies', whatever these hold; nor is what nobody booked.
    CHECK_FALSE(balance_warning(balance_of(sign * 49, 0), {5000, sign * 38}, hht).empty());
    CHECK_FALSE(balance_warning(balance_of(0, sign * 11), {5000, 0}, hht).empty());
    // Together they change little, one by one more.
    CHECK(balance_warning(balance_of(0, 0), {5000, sign * 49}, hht).empty());
  }
}

TEST_CASE("the warning says how much, of how much, and what to do") {
  const auto text = [](ParticleIntegrator particles, StepControl control, Real taken, Real missed) {
    return balance_warning(balance_of(taken, missed), {}, model_with(particles, control));
  };
  const std::string hht = text(ParticleIntegrator::hht, StepControl::fixed, -480, 0.5);
  CAPTURE(hht);
  CHECK(hht.find("by 480 J, 48 % of the 1000 J exchanged") != std::string::npos);
  CHECK(hht.find("took out -480 J, and 0.5 J are not accounted for") != std::string::npos);
  CHECK(hht.find("set time.control = \"adaptive\"") != std::string::npos);
  CHECK(text(ParticleIntegrator::hht, StepControl::adaptive, 20, 0).find("time.tolerance") !=
        std::string::npos);
  CHECK(text(ParticleIntegrator::velocity_verlet, StepControl::fixed, 0, 20).find("integrator.substeps") !=
        std::string::npos);
}

TEST_CASE("where next to nothing was exchanged the last bits of the energies are no reason to warn") {
  BalanceState balance = balance_of(0, 0);
  balance.exchanged = 1e-9, balance.last.kinetic += 1e-9;
  CHECK(balance_warning(balance, {}, model_with(ParticleIntegrator::hht, StepControl::fixed)).empty());
}

}  // namespace scree
