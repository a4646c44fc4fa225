// The progress line.
#include "run/report/progress.hpp"

#include <cmath>

#include "support/catch.hpp"

namespace scree {

TEST_CASE("durations are given in the two largest units") {
  CHECK(duration_text(0) == "0 s");
  CHECK(duration_text(59.4) == "59 s");
  CHECK(duration_text(59.6) == "1 min 00 s");
  CHECK(duration_text(200) == "3 min 20 s");
  CHECK(duration_text(7500) == "2 h 05 min");
  CHECK(duration_text(3600 * 76 + 59) == "3 d 04 h");
  CHECK(duration_text(-3) == "0 s");  // of a clock that is ahead
  CHECK(duration_text(std::nan("")) == "?");
  CHECK(duration_text(INFINITY) == "?");
}

TEST_CASE("the progress line has all known quantities, and no others") {
  Progress p;
  p.time = 0.25, p.end = 1, p.steps = 1000, p.step = 2.5e-4;
  CHECK(progress_line(p) == "t = 0.25 of 1 s (25 %), ? left, 1000 steps, h = 2.50e-04 s, ?, balance -");
  p.seconds_left = 200, p.step_rate = 50;
  CHECK(progress_line(p) ==
        "t = 0.25 of 1 s (25 %), 3 min 20 s left, 1000 steps, h = 2.50e-04 s, 50 steps/s, balance -");
  p.particles = 900, p.particle_step_rate = 45000, p.contacts = 17, p.balance_error = -2e-9, p.exchanged = 2;
  CHECK(progress_line(p) ==
        "t = 0.25 of 1 s (25 %), 3 min 20 s left, 1000 steps, h = 2.50e-04 s, 17 contacts, 4.5e+04 "
        "particle-steps/s, balance 1e-09");
  p.time = 0.99999;
  CHECK(percent_text(p) == "99 %");  // not finished yet
}

TEST_CASE("a rate is that of the last seconds, not of the whole run") {
  RecentRate rate;
  CHECK(std::isnan(rate.steps_per_second()));
  rate.add(100, 0, 0);
  CHECK(std::isnan(rate.time_per_second()));
  for (int second = 1; second <= 60; ++second) rate.add(100 + second, 10 * second, 0.5 * second);
  CHECK(rate.steps_per_second() == 10);
  CHECK(rate.time_per_second() == 0.5);
  for (int second = 61; second <= 90; ++second) rate.add(100 + second, 600 + (second - 60), 30);
  CHECK(rate.steps_per_second() == 1);
  CHECK(rate.time_per_second() == 0);
}

TEST_CASE("the rate of steps that take minutes each is that of the last one") {
  RecentRate rate;
  rate.add(0, 0, 0);
  rate.add(60, 1, 1);
  rate.add(180, 2, 2);
  CHECK(rate.steps_per_second() == 1.0 / 120);
}

}  // namespace scree
