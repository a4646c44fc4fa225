// What the command line says of one run, for all parts of the run.
#pragma once

#include <string>

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

}  // namespace scree
