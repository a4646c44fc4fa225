#include "run/report/summary.hpp"

#include <fmt/format.h>

#include "dem/search/skin_choice.hpp"
#include "model/checks/memory.hpp"

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

}  // namespace scree
