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

// A warning where the time integration has changed the energy by more than 1 % of what was exchanged; else
// empty.
std::string balance_warning(const BalanceState& balance, const Model& model);

}  // namespace scree
