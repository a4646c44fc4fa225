// Run record: what was run, with what, and what it cost.
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
  std::string deck_path, resolved_deck;  // the deck with defaults filled in, as TOML
  std::string command_line;
  std::string status;  // "running", "done", "failed: ...", "stopped by signal ..."
  int exit_code = 0;
  std::string started, ended;    // ISO 8601, UTC
  std::vector<RunStart> starts;  // this one last
  std::string backend, solver;
  std::string start_change;  // velocities = "consistent": the largest change at t = 0
  std::string redundancy;    // of constraints that share the load: rows, rank, names
  std::string restarted_from;
  std::string changes;     // lines on the keys that --allow-changes let differ since t = 0
  std::string state_hash;  // of the state in the last checkpoint; empty before the first
  int ranks = 1;
  std::int64_t device_bytes = 0;  // of GPU memory at the end, all ranks together; 0 on the CPU
  StageTimers timers;
  std::vector<std::pair<std::string, std::int64_t>>
      counts;                                            // steps, iterations, rejections, list builds, ...
  std::vector<std::pair<std::string, double>> measures;  // simulated time, energy balance, ...
  std::vector<std::string> warnings;
};

// Writes DIRECTORY/run_record.json (beside and renamed): the fields above, versions, commit, host. Throws
// IoError.
void write_run_record(const std::string& directory, const RunRecord& record);

}  // namespace scree
