// Run record: deck, program, environment and cost of a run.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/timer.hpp"
#include "base/types.hpp"
#include "output/run_starts.hpp"

namespace scree {

struct RunRecord {
  std::string deck_path, resolved_deck;  // the deck including defaults, as TOML
  std::string command_line;
  std::string status;          // "running", "done", "failed: ...", "stopped by signal ..."
  std::string stop_condition;  // the one that ended the run; empty: none
  int exit_code = 0;
  std::string started, ended;    // ISO 8601, UTC
  std::vector<RunStart> starts;  // this start is the last one
  std::string backend, solver;
  std::string start_change;  // for velocities = "consistent": the largest change at t = 0
  std::string redundancy;    // redundant constraints: rows, rank, names
  std::string restarted_from;
  std::string changes;     // keys changed with --allow-changes since t = 0, one per line
  std::string state_hash;  // of the last checkpoint; empty before the first one
  int ranks = 1;
  std::int64_t device_bytes = 0;  // GPU memory at the end, summed over the ranks; 0 on the CPU
  StageTimers timers;
  std::vector<std::pair<std::string, std::int64_t>>
      counts;                                            // steps, iterations, rejections, list builds, ...
  std::vector<std::pair<std::string, double>> measures;  // simulated time, energy balance, ...
  std::vector<std::string> warnings;
};

// Writes DIRECTORY/run_record.json (under another name, then renamed): the fields above, versions, commit,
// host. Throws IoError.
void write_run_record(const std::string& directory, const RunRecord& record);

}  // namespace scree
