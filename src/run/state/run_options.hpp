// What the command line says of one run.
#pragma once

#include <cstdint>
#include <string>

#include "partition/ranks.hpp"

namespace scree {

// A timeline of some steps. from, steps: the first one, counted from the start of this run, and how many.
struct TraceOptions {
  std::string file;  // empty: none is written
  std::int64_t from = 0, steps = 200;
};

struct RunOptions {
  std::string backend = "auto";  // auto, cpu, cuda
  std::string output_directory;
  std::string restart;         // checkpoint to continue from; empty: the run starts at t = 0
  bool allow_changes = false;  // the checkpoint may belong to another deck
  std::string deck_path, resolved_deck, fingerprint, command_line;  // for the run record and the checkpoint
  Ranks ranks;
  bool overwrite = false;  // remove results of an earlier run in the output directory
  TraceOptions trace{};
};

}  // namespace scree
