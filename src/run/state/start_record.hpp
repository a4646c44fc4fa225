// Time and steps of this start of the program, together with those of earlier starts.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "output/run_starts.hpp"
#include "run/state/state.hpp"

namespace scree {

// Text on the last start, "1.20 s wall, 1.10 s CPU", and on all starts if there are several: "; all 2 starts
// of the run ...".
std::string took_text(const std::vector<RunStart>& starts);

class StartRecord {
 public:
  // earlier: starts stored in the checkpoint of a restart; state: before the first step. Wall time counts
  // from the construction, CPU time likewise.
  StartRecord(std::vector<RunStart> earlier, const State& state, const std::string& started,
              const std::string& backend, int ranks);

  void begin_loop() { loop_start_ = Clock::now(), in_loop_ = true; }
  void end_loop();
  // All starts, this one last, up to the given state.
  std::vector<RunStart> starts(const State& state) const;

 private:
  using Clock = std::chrono::steady_clock;

  double loop_seconds() const;

  std::vector<RunStart> earlier_;
  RunStart own_;  // without its duration
  std::int64_t first_step_;
  double start_cpu_;
  Clock::time_point start_ = Clock::now(), loop_start_ = start_;
  bool in_loop_ = false;
  double loop_seconds_ = 0;
};

}  // namespace scree
