// The energy balance of a run: its error, the energy exchanged as its measure, and the warning at the end.
#pragma once

#include <cstdint>
#include <string>

#include "model/data/model.hpp"
#include "run/state/state.hpp"

namespace scree {

// Balance error: accounted energy now less that at t = 0 [J].
inline Real balance_error(const BalanceState& balance) { return balance.last.accounted() - balance.start; }

// Energy taken out by the time integration since t = 0 [J].
inline Real taken_by_integrator(const BalanceState& balance) {
  return balance.last.dissipated_integrator - balance.start_integrator;
}

// The first number of steps above `steps` at which the energies are sampled. It depends on `steps` alone, so
// that outputs do not shift the samples. Samples are taken every 4 steps (implicit) or 128 steps (explicit)
// at first; from 128 or 4096 steps on, 16 times per doubling of the number of steps; finally every 8 or 1024
// steps.
std::int64_t next_energy_sample(std::int64_t steps, bool implicit);

// The extremes of a single instant. kinetic: energy of the particles that have not escaped; elastic: energy
// of force elements [J].
EnergyExtremes extremes_at(Real kinetic, Real elastic, const MultibodyState& bodies);

// The energy exchanged up to an instant [J]. now: the ledger at that instant, which `extremes` include.
//   max T_p                    largest kinetic energy of the particles
//   + max T_b - min T_b        range of the kinetic energy of bodies
//   + max V_e - min V_e        range of the elastic energy of force elements
//   + max W - min W            range of the drivers' work
//   + D_c + D_e                energy dissipated in contacts and force elements
Real energy_exchanged(const EnergyExtremes& extremes, const MultibodyState& bodies, const Ledger& now);

// Widens the extremes by the energies at a sample's instant.
void add_sample(BalanceState& balance, const EnergyExtremes& now);
// Updates the balance at a row of the history; the first row opens the balance. The sampled extremes stay
// unchanged.
void add_row(BalanceState& balance, const Ledger& ledger, const EnergyExtremes& now,
             const MultibodyState& bodies);
// Continues the balance after a restart with another deck: from its last row, with the energies of the new
// deck.
void rebase(BalanceState& balance, const Ledger& ledger, const EnergyExtremes& now);

// Energies of the bodies at the end of a run [J].
struct BodyBalance {
  Real held = 0;       // kinetic and elastic energy
  Real taken = 0;      // by the time integration, as its ledger entry says
  Real round_off = 0;  // energies of the bodies below this are round-off
};
BodyBalance body_balance(const Model& model, const Multibody& bodies, const State& state);

// A warning if the time integration has changed the energy by more than 1 % of the energy exchanged; else an
// empty text. Energy taken out of bodies counts only above 1 % of the energy that they hold. This is the only
// text of a run that names a remedy for the balance error.
std::string balance_warning(const BalanceState& balance, const BodyBalance& bodies, const Model& model);

}  // namespace scree
