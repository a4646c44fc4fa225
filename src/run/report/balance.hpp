// The energy balance of a run, what it is measured by, and what a run tells of it at its end.
#pragma once

#include <cstdint>
#include <string>

#include "model/data/model.hpp"
#include "run/state/state.hpp"

namespace scree {

// What the ledger fails to account for since t = 0 [J].
inline Real balance_error(const BalanceState& balance) { return balance.last.accounted() - balance.start; }

// What the time integration has taken out since t = 0 [J].
inline Real taken_by_integrator(const BalanceState& balance) {
  return balance.last.dissipated_integrator - balance.start_integrator;
}

// The first number of steps above `steps` after which the energies are sampled. It follows from `steps`
// alone, so that no output moves the samples: every 4 steps (implicit) or 128 (explicit), from 128 or 4096
// steps on 16 times while the number of steps doubles, at last every 8 or 1024 steps.
std::int64_t next_energy_sample(std::int64_t steps, bool implicit);

// Of one instant. kinetic: of particles that have not left; elastic: of force elements [J].
EnergyExtremes extremes_at(Real kinetic, Real elastic, const MultibodyState& bodies);

// The energy exchanged up to an instant [J], with the ledger then; the extremes include that instant:
//   max T_p                    the most kinetic energy of particles at a time
//   + max T_b - min T_b        the range of that of bodies
//   + max V_e - min V_e        the range of the elastic energy of force elements
//   + max W - min W            the range of the drivers' work
//   + D_c + D_e                what contacts and force elements have dissipated
Real energy_exchanged(const EnergyExtremes& extremes, const MultibodyState& bodies, const Ledger& now);

// The energies at a sample's instant.
void add_sample(BalanceState& balance, const EnergyExtremes& now);
// At a row of the history; the first one opens the balance. Leaves the samples as they are.
void add_row(BalanceState& balance, const Ledger& ledger, const EnergyExtremes& now,
             const MultibodyState& bodies);
// After a restart with another deck: the balance goes on from its last row, with the energies of this deck.
void rebase(BalanceState& balance, const Ledger& ledger, const EnergyExtremes& now);

// Of bodies at the end of a run [J].
struct BodiesBook {
  Real held = 0;       // kinetic and elastic energy
  Real taken = 0;      // what the time integration took out of them, by its entry
  Real round_off = 0;  // below which no energy of theirs says anything
};
BodiesBook bodies_book(const Model& model, const Multibody& bodies, const State& state);

// A warning where the time integration has changed the energy by more than 1 % of the energy exchanged; what
// it took out of bodies counts from 1 % of what they hold on; else empty. No other text states a remedy.
std::string balance_warning(const BalanceState& balance, const BodiesBook& bodies, const Model& model);

}  // namespace scree
