// What a run tells of itself while it goes on: a small file in its folder, for whoever looks from outside.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

// How far a run is. Rates are of the last seconds of the clock on the wall, not since the start.
struct Progress {
  Real time = 0, end = 0;  // simulated [s]
  std::int64_t steps = 0;
  Real step = 0;                          // length of the last one [s]
  std::int64_t particles = 0;             // inside the space
  std::int64_t contacts = -1;             // touching, at the last row of the history; below zero: not known
  Real balance_error = 0, exchanged = 0;  // likewise [J]
  double step_rate = std::nan("");        // [1/s]; NaN: not known
  double particle_step_rate = 0;          // steps and substeps of all particles [1/s]
  double seconds_left = std::nan("");     // NaN: not known
};

struct RunStatus {
  std::string state;  // "running", "done", "failed: ...", "stopped by signal: ..."
  std::string host, process;
  std::string started, written;  // UTC; written: this file
  std::string deck, backend;
  std::int64_t ranks = 1;
  Progress progress;
  double wall_seconds = 0;
  std::string checkpoint, checkpoint_written;  // the last one's file and when, UTC; empty: none
  Real checkpoint_time = 0;                    // simulated [s]
  std::int64_t snapshots = 0, history_rows = 0;
  std::vector<std::string> warnings;
};

inline constexpr const char* kStatusName = "status.toml";

// Writes FOLDER/status.toml at one instant. Throws IoError.
void write_status(const std::string& folder, const RunStatus& status);
// Throws IoError where the file cannot be read or is none that write_status() has written.
RunStatus read_status(const std::string& folder);

}  // namespace scree
