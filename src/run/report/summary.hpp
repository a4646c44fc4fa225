// Lines of the log at the start and at the end of a run.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
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
// Particles born, waiting and removed in outlets.
std::string population_text(const State& state);

// Numbers of all ranks that the state does not have.
struct RankSums {
  std::int64_t list_entries = 0, migrated = 0, snapshots = 0;
};
// RunRecord::counts and RunRecord::measures.
std::vector<std::pair<std::string, std::int64_t>> record_counts(const Model& model, const State& state,
                                                                const StepCounts& steps, const RankList& list,
                                                                const RankSums& sums);
std::vector<std::pair<std::string, double>> record_measures(const State& state, const RankList& list);

}  // namespace scree
