#include "run/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr Real kMostShare = 0.01;  // of the energy exchanged
constexpr Real kRoundOff = 1e-9;   // of all energies: where less was exchanged, nothing is said

}  // namespace

void add_sample(BalanceState& balance, const Ledger& ledger) {
  if (!balance.open) balance = {true, ledger.accounted(), 0, ledger};
  balance.exchanged += energy_exchanged(balance.last, ledger);
  balance.last = ledger;
}

// HHT books what it does as an entry of its own; what velocity-Verlet does to contacts is the balance error.
std::string balance_warning(const BalanceState& balance, const Model& model) {
  const Real error = balance_error(balance), taken = balance.last.dissipated_integrator;
  const Real largest = std::max(std::abs(error), std::abs(taken));
  Real all = 0;
  for (const Real entry : balance.last.entries()) all += std::abs(entry);
  if (!(largest > kMostShare * balance.exchanged && largest > kRoundOff * all)) return "";
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  const bool fixed = model.time.control != StepControl::adaptive;
  return fmt::format(
      "the time integration has changed the energy by {:.3g} J, {:.2g} % of the {:.4g} J exchanged (it "
      "took out {:.3g} J, and {:.3g} J are not accounted for): {}",
      largest, 100 * largest / balance.exchanged, balance.exchanged, taken, error,
      !implicit ? "shorten time.step, or raise integrator.substeps"
      : fixed   ? "shorten time.step, or set time.control = \"adaptive\""
                : "lower time.tolerance, or bring integrator.hht_alpha nearer to 0");
}

}  // namespace scree
