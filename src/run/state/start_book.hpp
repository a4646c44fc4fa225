// What this start of the program takes, beside the starts before it.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "output/run_starts.hpp"
#include "run/state/state.hpp"

namespace scree {

// "1.20 s wall, 1.10 s CPU" of the last one; where there are others "; with 2 starts before it ..." of all.
std::string took_text(const std::vector<RunStart>& starts);

class StartBook {
 public:
  // earlier: of the checkpoint that the run goes on from. state: that the steps begin with. The wall clock
  // runs from here on, as the processor's does for this process.
  StartBook(std::vector<RunStart> earlier, const State& state, const std::string& started,
            const std::string& backend, int ranks);

  void begin_loop() { loop_start_ = Clock::now(), in_loop_ = true; }
  void end_loop();
  // With this one last, up to the state.
  std::vector<RunStart> starts(const State& state) const;

 private:
  using Clock = std::chrono::steady_clock;

  double loop_seconds() const;

  std::vector<RunStart> earlier_;
  RunStart own_;  // but for what it has taken
  std::int64_t first_step_;
  double start_cpu_;
  Clock::time_point start_ = Clock::now(), loop_start_ = start_;
  bool in_loop_ = false;
  double loop_seconds_ = 0;
};

}  // namespace scree
