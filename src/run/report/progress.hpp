// Progress and speed of a run as texts.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "base/types.hpp"
#include "output/status_file.hpp"

namespace scree {

// "12 s", "3 min 20 s", "2 h 05 min", "3 d 04 h"; "?" for a value that is not finite.
std::string duration_text(double seconds);
// Simulated time over the end time, in percent.
std::string percent_text(const Progress& progress);
// "1.2e+07 particle-steps/s", without particles "3.1e+04 steps/s"; "?" if not known.
std::string rate_text(const Progress& progress);
// Balance error over the energy exchanged: "2e-09"; "-" without exchanged energy.
std::string balance_text(const Progress& progress);
// All on one line, the most important parts first.
std::string progress_line(const Progress& progress);

// Steps and simulated time per second of wall time, over the last seconds.
class RecentRate {
 public:
  // wall: time of a monotonic clock [s]; time: simulated time [s].
  void add(double wall, std::int64_t steps, Real time);
  // Steps per second and simulated seconds per second; NaN before the second sample.
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
