// One run from a model to its files.
#pragma once

#include <string>

#include "base/error.hpp"
#include "base/log.hpp"
#include "model/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

struct RunOptions {
  std::string backend = "auto";  // auto, cpu, cuda
  std::string output_directory;
  std::string restart;         // checkpoint to continue from; empty: start at t = 0
  bool allow_changes = false;  // from one of another deck, too
  std::string deck_path, resolved_deck, fingerprint, command_line;  // for the run record and the checkpoint
  Ranks ranks;
  bool overwrite = false;  // results of an earlier run in the output directory are removed
};

// Runs to the end and writes snapshots, history, checkpoints and the run record into the output directory.
// A failed simulation leaves a checkpoint of its last good state. Throws InputError and IoError. Collective;
// rank 0 writes the files.
ExitCode run_simulation(const Model& model, const RunOptions& options, Log& log);

}  // namespace scree
