// How far a run is, in words, and how fast it goes.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "base/types.hpp"
#include "output/status_file.hpp"

namespace scree {

// "12 s", "3 min 20 s", "2 h 05 min", "3 d 04 h"; "?" for what is not finite.
std::string duration_text(double seconds);
// Share of the end, in percent.
std::string percent_text(const Progress& progress);
// "1.2e+07 particle-steps/s", without particles "3.1e+04 steps/s"; "?" where it is not known.
std::string rate_text(const Progress& progress);
// The balance error over the energy exchanged: "2e-09"; "-" where none was.
std::string balance_text(const Progress& progress);
// All of it on one line, the parts that matter most first.
std::string progress_line(const Progress& progress);

// Steps and simulated time per second of the clock on the wall, over the last seconds.
class RecentRate {
 public:
  // wall: of a clock that never goes back [s]; time: simulated [s].
  void add(double wall, std::int64_t steps, Real time);
  // NaN before the second sample.
  double steps_per_second() const;
  double time_per_second() const;

 private:
  struct Sample {
    double wall;
    std::int64_t steps;
    Real time;
  };

  std::deque<Sample> samples_;
};

}  // namespace scree
