// Lines of the log at the start and at the end of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/timer.hpp"
#include "coupling/coupled_step.hpp"
#include "dem/backend/rank_list.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"
#include "run/report/balance.hpp"

namespace scree {

// Changes of the bodies' initial velocities and redundant constraints; null: no bodies, or not rank 0.
std::vector<std::string> start_lines(const Multibody* bodies);
// t [s].
std::string steps_text(const StepCounts& counts, Real t);
std::string lagged_text(const StepCounts& counts);
// Follows steps_text(): list builds, their share of the time, and the skin with its origin.
std::string lists_text(const Model& model, const RankList& list, const StageTimers& timers);
// escaped: number of particles; bodies: number of bodies outside the domain.
std::string balance_text(const BalanceState& balance, std::int64_t escaped, std::int64_t bodies);

}  // namespace scree
