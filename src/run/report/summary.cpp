#include "run/report/summary.hpp"

#include <fmt/format.h>

#include "dem/search/skin_choice.hpp"
#include "model/checks/memory.hpp"
#include "run/report/bodies_outside.hpp"

namespace scree {

std::vector<std::string> start_lines(const Multibody* bodies) {
  std::vector<std::string> lines;
  if (bodies != nullptr && !bodies->start_change().empty())
    lines.push_back("velocities = \"consistent\": the largest change at t = 0 is that of the " +
                    bodies->start_change());
  if (bodies != nullptr && !bodies->redundancy().empty())
    lines.push_back(
        "redundant constraints: the reactions, which are not unique for rigid bodies, are the minimum-norm "
        "solution: " +
        bodies->redundancy());
  return lines;
}

std::string lagged_text(const StepCounts& counts) {
  return fmt::format("the friction limits were lagged in {} of the steps: shorter steps would resolve them",
                     counts.lagged_steps);
}

std::string steps_text(const StepCounts& counts, Real t) {
  return fmt::format("t = {:g} s after {} steps ({} rejected), {} Newton and {} linear iterations", t,
                     counts.steps, counts.rejected_error + counts.rejected_newton, counts.newton_iterations,
                     counts.linear_iterations);
}

std::string lists_text(const Model& model, const RankList& list, const StageTimers& timers) {
  const char* const origin = chooses_skin(model)             ? "chosen by the program"
                             : model.contact.skin_is_default ? "the default"
                                                             : "as in the deck";
  return fmt::format(", {} list builds ({:.0f} % of the time without output; skin {:.3g} m, {})",
                     list.builds(), 100 * timers.share(kListStages), list.skin(), origin);
}

std::string balance_text(const BalanceState& balance, std::int64_t escaped, std::int64_t bodies) {
  return fmt::format(
      "energy balance error {:.2e} J of {:.4g} J exchanged, {:.2e} J taken out by the time integration; {} "
      "escaped from the domain{}",
      balance_error(balance), balance.exchanged, taken_by_integrator(balance),
      counted(escaped, "particle", "particles"),
      bodies == 0 ? "" : ", " + counted(bodies, "body is outside", "bodies are outside"));
}

std::string population_text(const State& state) {
  const PopulationState& population = state.population;
  std::int64_t dropped = 0;
  for (const std::int64_t of_inserter : population.dropped) dropped += of_inserter;
  std::string text = counted(population.born(), "particle", "particles") + " born";
  if (!population.waiting.empty())
    text += fmt::format(", {} still wait for a free position", population.waiting.size() / kWaitingNumbers);
  if (dropped > 0) text += fmt::format(", {} dropped because no position was free", dropped);
  return text + fmt::format(", {} removed in outlets", state.outlets.removed_of_all());
}

std::vector<std::pair<std::string, std::int64_t>> record_counts(const Model& model, const State& state,
                                                                const StepCounts& steps, const RankList& list,
                                                                const RankSums& sums) {
  return {{"steps", steps.steps},
          {"substeps", model.integrator.substeps},
          {"newton_iterations", steps.newton_iterations},
          {"linear_iterations", steps.linear_iterations},
          {"rejected_error", steps.rejected_error},
          {"rejected_newton", steps.rejected_newton},
          {"frozen_steps", steps.lagged_steps},
          {"list_builds", list.builds()},
          {"list_skin_chosen", chooses_skin(model) ? 1 : 0},
          {"list_entries", sums.list_entries},
          {"rebalances", list.balance().rebalances},
          {"migrated", sums.migrated},
          {"particles", particles_so_far(model.particles, state.population)},
          {"particles_removed", state.outlets.removed_of_all()},
          {"bodies", static_cast<std::int64_t>(model.bodies.size())},
          {"particles_escaped", state.carried_out.left},
          {"bodies_outside", bodies_outside(model, state.bodies).count},
          {"history_rows", state.history_rows},
          {"snapshots", sums.snapshots}};
}

std::vector<std::pair<std::string, double>> record_measures(const State& state, const RankList& list) {
  const BalanceState& b = state.balance;
  const LoadBalance balance = list.balance();
  return {{"simulated_time", state.clock.time},
          {"balance_error", balance_error(b)},
          {"energy_exchanged", b.exchanged},
          {"energy_taken_by_integrator", taken_by_integrator(b)},
          {"imbalance", balance.imbalance},
          {"largest_imbalance", balance.largest},
          {"list_skin", list.skin()}};
}

}  // namespace scree
