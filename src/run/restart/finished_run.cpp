#include "run/restart/finished_run.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace scree {

void check_end(const StepClock& clock, const TimeControl& time, const RunOptions& options, Log& log) {
  if (clock.time() > clock.end())
    throw InputError(fmt::format("--restart {}: the checkpoint is at t = {} s, past time.end = {} s",
                                 options.restart, clock.time(), time.end));
  if (clock.done())
    log.info(fmt::format(
        "--restart {}: nothing left to do: the run has reached time.end = {} s; a later one, --set "
        "time.end=..., continues it",
        options.restart, time.end));
}

void report_stop(const std::string& reason, const RunOptions& options, Log& log) {
  if (reason.empty()) return;
  log.info(
      fmt::format("--restart {}: nothing left to do: the run was ended by the stop condition {}; it "
                  "continues if [[stop]] "
                  "has other values or lacks the condition",
                  options.restart, reason));
}

}  // namespace scree
