// The energy balance from sample to sample of the history, and what a run tells of it at its end.
#pragma once

#include <string>

#include "model/model.hpp"
#include "run/state.hpp"

namespace scree {

// What the ledger fails to account for since t = 0 [J].
inline Real balance_error(const BalanceState& balance) { return balance.last.accounted() - balance.start; }

// The ledger at the next history row; the first one opens the balance.
void add_sample(BalanceState& balance, const Ledger& ledger);

// Of bodies at the end of a run [J].
struct BodiesBook {
  Real held = 0;   // kinetic and elastic energy
  Real taken = 0;  // what the time integration took out of them, and booked
};
BodiesBook bodies_book(const Multibody& bodies, const MultibodyState& state, Real t);

// A warning where the time integration has changed the energy by more than 1 % of what was exchanged, what it
// took out of bodies by more than 1 % of what they hold, too; else empty.
std::string balance_warning(const BalanceState& balance, const BodiesBook& bodies, const Model& model);

}  // namespace scree
