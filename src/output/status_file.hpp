// Status of a running simulation: a small file in its folder, for observers.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

// Progress of a run. Rates are averages over the last seconds of wall time.
struct Progress {
  Real time = 0, end = 0;  // simulated [s]
  std::int64_t steps = 0;
  Real step = 0;                          // length of the last step [s]
  std::int64_t particles = 0;             // inside the domain
  std::int64_t contacts = -1;             // at the last row of the history; negative: not known
  Real balance_error = 0, exchanged = 0;  // at the last row of the history [J]
  double step_rate = std::nan("");        // [1/s]; NaN: not known
  double particle_step_rate = 0;          // steps and substeps of all particles [1/s]
  double seconds_left = std::nan("");     // NaN: not known
};

struct RunStatus {
  std::string state;           // "running", "done", "failed: ...", "stopped by signal: ..."
  std::string stop_condition;  // the one that ended the run; empty: none
  std::string host, process;
  std::string started, written;  // UTC; written: time of this status
  std::string deck, backend;
  std::int64_t ranks = 1;
  Progress progress;
  double wall_seconds = 0;
  std::string checkpoint, checkpoint_written;  // last checkpoint: file and time (UTC); empty: none
  Real checkpoint_time = 0;                    // simulated [s]
  std::int64_t snapshots = 0, history_rows = 0;
  std::vector<std::string> warnings;
};

inline constexpr const char* kStatusName = "status.toml";

// Writes FOLDER/status.toml atomically. Throws IoError.
void write_status(const std::string& folder, const RunStatus& status);
// Reads FOLDER/status.toml. Throws IoError if it cannot be read or was not written by write_status().
RunStatus read_status(const std::string& folder);

}  // namespace scree
