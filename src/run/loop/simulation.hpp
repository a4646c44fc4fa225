// One complete run: from a model to its result files.
#pragma once

#include "base/error.hpp"
#include "base/log.hpp"
#include "model/data/model.hpp"
#include "run/state/run_options.hpp"

namespace scree {

// Runs to the end and writes snapshots, history, checkpoints and the run record into the output directory. A
// failed simulation writes a checkpoint of its last good state. Throws InputError and IoError. Collective;
// rank 0 writes the files.
ExitCode run_simulation(const Model& model, const RunOptions& options, Log& log);

}  // namespace scree
