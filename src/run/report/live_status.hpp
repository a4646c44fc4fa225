// Output of a run while it goes on: the progress line, and the file that `scree status` reads.
#pragma once

#include <chrono>
#include <string>

#include "base/log.hpp"
#include "model/data/model.hpp"
#include "output/status_file.hpp"
#include "run/report/progress.hpp"
#include "run/state/run_options.hpp"
#include "run/state/state.hpp"

namespace scree {

// Uses data on the host alone, so that it neither slows steps down nor changes them.
class LiveStatus {
 public:
  // backend: description of the backend.
  LiveStatus(const Model& model, const RunOptions& options, const std::string& backend, Log& log);

  // Takes the state before the first step.
  void begin(const State& state);
  // Called after each step or batch of steps. h: length of the last step [s]; contacts: number at the last
  // row of the history, negative before the first row. Rewrites the progress line on a terminal; in a log it
  // prints a line per tenth of the run, and after ten minutes without one. Returns whether recorded data
  // should be flushed to disk.
  bool poll(const State& state, Real h, std::int64_t contacts);
  // Notes a new checkpoint. name: file name; time: simulated time [s].
  void checkpoint_written(const std::string& name, Real time);
  // Notes the stop condition that ended the run; empty: none.
  void ended_by(const std::string& stop_condition) { status_.stop_condition = stop_condition; }
  // Writes the status file, on rank 0. A full disk does not end the run here, because writing the results
  // will report it. word: RunStatus::state; contacts: as above.
  void write(const std::string& word, const State& state, std::int64_t contacts, std::int64_t snapshots);

  const std::string& started() const { return status_.started; }  // UTC
  double wall_seconds() const;                                    // wall time since the start [s]

 private:
  using Clock = std::chrono::steady_clock;

  void add_to_rate(const State& state);
  void take(const State& state, std::int64_t contacts);

  const Model& model_;
  const RunOptions& options_;
  Log& log_;
  RunStatus status_;
  RecentRate rate_;
  Clock::time_point start_ = Clock::now(), last_poll_ = start_, last_logged_ = start_, last_flush_ = start_;
  Real start_time_ = 0;  // simulated time [s]
  int tenths_reported_ = 0;
};

}  // namespace scree
