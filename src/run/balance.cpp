#include "run/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr Real kMostShare = 0.01;  // of the energy exchanged
constexpr Real kRoundOff = 1e-9;   // of all energies: where less was exchanged, nothing is said

// Beside bodies more substeps leave what the bodies' own step does to contacts.
const char* advice_of_explicit(const Model& model) {
  return model.bodies.empty() ? "shorten time.step, or raise integrator.substeps" : "shorten time.step";
}

}  // namespace

void add_sample(BalanceState& balance, const Ledger& ledger) {
  if (!balance.open) balance = {true, ledger.accounted(), 0, ledger};
  balance.exchanged += energy_exchanged(balance.last, ledger);
  balance.last = ledger;
}

BodiesBook bodies_book(const Multibody& bodies, const MultibodyState& state, Real t) {
  const MultibodyEnergies energies = bodies.energies(state, t);
  return {energies.kinetic + std::abs(energies.elastic), state.integrator_loss};
}

// HHT books what it does as an entry of its own; what velocity-Verlet does to contacts is the balance error.
// Bodies may hold much and exchange next to nothing, as a crank that is driven at constant speed: what was
// taken out of them is then little for what they hold. What they held earlier and hold no more was exchanged.
std::string balance_warning(const BalanceState& balance, const BodiesBook& bodies, const Model& model) {
  const Real error = balance_error(balance), taken = balance.last.dissipated_integrator;
  Real counts = std::abs(taken);
  if (std::abs(bodies.taken) <= kMostShare * bodies.held)
    counts = std::min(counts, std::abs(taken - bodies.taken));
  Real all = 0;
  for (const Real entry : balance.last.entries()) all += std::abs(entry);
  const Real most = std::max(kMostShare * balance.exchanged, kRoundOff * all);
  if (!(std::max(std::abs(error), counts) > most)) return "";
  const Real largest = std::max(std::abs(error), std::abs(taken));
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const bool fixed = model.time.control != StepControl::adaptive;
  return fmt::format(
      "the time integration has changed the energy by {:.3g} J, {:.2g} % of the {:.4g} J exchanged (it "
      "took out {:.3g} J, and {:.3g} J are not accounted for): {}",
      largest, 100 * largest / balance.exchanged, balance.exchanged, taken, error,
      !implicit ? advice_of_explicit(model)
      : fixed   ? "shorten time.step, or set time.control = \"adaptive\""
                : "lower time.tolerance, or bring integrator.hht_alpha nearer to 0");
}

}  // namespace scree
