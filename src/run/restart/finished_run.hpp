// Restarts of runs that have reached their end.
#pragma once

#include <string>

#include "base/log.hpp"
#include "model/data/model.hpp"
#include "run/state/run_options.hpp"
#include "run/state/step_clock.hpp"

namespace scree {

// Throws InputError if the checkpoint is past the end of the run; at the end, logs that nothing is left to
// do. If the end is a multiple of an interval, a checkpoint at the end may be past it by round-off.
void check_end(const StepClock& clock, const TimeControl& time, const RunOptions& options, Log& log);
// Logs that a stop condition has ended the run, if there is a reason: StopConditions::reason().
void report_stop(const std::string& reason, const RunOptions& options, Log& log);

}  // namespace scree
