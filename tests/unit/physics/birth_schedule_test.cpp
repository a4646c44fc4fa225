#include "physics/birth_schedule.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

TEST_CASE("a schedule of births at once is due from its instant on") {
  const BirthSchedule schedule = BirthSchedule::at_once(0.5, 12);
  CHECK(schedule.due(std::nextafter(0.5, 0)) == 0);
  CHECK(schedule.due(0.5) == 12);
  CHECK(schedule.time_of(1) == 0.5);
  CHECK(schedule.time_of(12) == 0.5);
  CHECK(schedule.time_of(13) == kInfinity);
  CHECK((schedule.is_due(12, 0.5) && !schedule.is_due(13, 0.5)));
}

TEST_CASE("a constant rate is due in proportion to the time, and its total exactly at its end") {
  const Real rate = GENERATE(Real(700), Real(0.1), Real(1) / 3);
  const BirthSchedule schedule = BirthSchedule::by_rate({1, 11}, {rate, rate}, kInfinity);
  CHECK(schedule.due(1) == 0);
  CHECK(near(schedule.due(6), 5 * rate, {.relative = 1e-15}));
  const auto births = std::round(10 * rate);
  if (near(births, 10 * rate, {.relative = 1e-12})) CHECK(schedule.is_due(births, 11));
  CHECK(schedule.due(20) == schedule.due(11));
  for (const Real amount : {0.25, 0.5, 1.0}) {
    const Real t = schedule.time_of(amount * 10 * rate);
    CHECK(near(t, 1 + 10 * amount, {.relative = 1e-14}));
    CHECK(schedule.is_due(amount * 10 * rate, t));
  }
  CHECK(schedule.time_of(10.1 * rate) == kInfinity);
}

TEST_CASE("a table of rates is integrated exactly, and time_of() is the inverse of due()") {
  // 0 to 4 per second within 2 s, constant for 1 s, and down to 1: 4 + 4 + 5.
  const BirthSchedule schedule = BirthSchedule::by_rate({0, 2, 3, 5}, {0, 4, 4, 1}, kInfinity);
  CHECK(near(schedule.due(1), 1.0, {.relative = 1e-15}));
  CHECK(near(schedule.due(2), 4.0, {.relative = 1e-15}));
  CHECK(near(schedule.due(3), 8.0, {.relative = 1e-15}));
  CHECK(near(schedule.due(5), 13.0, {.relative = 1e-15}));
  CHECK(schedule.largest_rate() == 4);
  for (Real amount = 0.05; amount < 13; amount += 0.05)
    CHECK(near(schedule.due(schedule.time_of(amount)), amount, {.relative = 1e-13}));
}

TEST_CASE("a total ends a rate before its time") {
  const BirthSchedule schedule = BirthSchedule::by_rate({0, 10}, {5, 5}, 12);
  CHECK(schedule.due(10) == 12);
  CHECK(near(schedule.due(2), 10.0, {.relative = 1e-15}));
  CHECK(near(schedule.time_of(12), 2.4, {.relative = 1e-14}));
  CHECK(schedule.time_of(13) == kInfinity);
}

}  // namespace scree
