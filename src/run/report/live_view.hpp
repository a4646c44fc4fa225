// What a run shows of itself while it goes on: its progress line, and the file that `scree status` reads.
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

// Looks at nothing but what the host has at hand: it costs no step anything, and moves none.
class LiveView {
 public:
  // backend: its description.
  LiveView(const Model& model, const RunOptions& options, const std::string& backend, Log& log);

  // The state that the steps begin with.
  void begin(const State& state);
  // After each step or batch of them; h: length of the last one [s]; contacts: touching at the last row of
  // the history, below zero where there was none. Rewrites the progress line, or prints it: in a log a line
  // per tenth of the run, and after ten minutes without one. Whether it is time to bring to disk what was
  // recorded.
  bool look(const State& state, Real h, std::int64_t contacts);
  // name: of the file.
  void checkpoint_written(const std::string& name, Real time);
  // Leaves the status file, on rank 0. A disk that is full does not end a run here: results will tell. word:
  // RunStatus::state; contacts: as above.
  void write(const std::string& word, const State& state, std::int64_t contacts, std::int64_t snapshots);

  const std::string& started() const { return status_.started; }  // UTC
  double wall_seconds() const;                                    // since then

 private:
  using Clock = std::chrono::steady_clock;

  void add_to_rate(const State& state);
  void take(const State& state, std::int64_t contacts);

  const Model& model_;
  const RunOptions& options_;
  Log& log_;
  RunStatus status_;
  RecentRate rate_;
  Clock::time_point start_ = Clock::now(), last_look_ = start_, last_logged_ = start_, last_flush_ = start_;
  Real start_time_ = 0;  // simulated
  int tenths_reported_ = 0;
};

}  // namespace scree
