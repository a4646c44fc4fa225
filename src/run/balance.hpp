// What a run tells of its energy balance at its end.
#pragma once

#include <string>

#include "model/model.hpp"
#include "run/state.hpp"

namespace scree {

// What the ledger fails to account for since t = 0 [J].
inline Real balance_error(const BalanceState& balance) { return balance.last.accounted() - balance.start; }

// A warning where the time integration has changed the energy by more than 1 % of what was exchanged; else
// empty.
std::string balance_warning(const BalanceState& balance, const Model& model);

}  // namespace scree
