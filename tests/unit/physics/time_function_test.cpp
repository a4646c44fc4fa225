// Functions of time and the derivatives that they state.
#include "physics/time_function.hpp"

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;

// Differences over the step h of rate and acceleration, whose round-off and truncation stay below `margin`.
template <class Function>
void check_derivatives(const Function& f, Real t, Real margin) {
  constexpr Real h = 1e-5;
  CAPTURE(t);
  CHECK(near(f(t).rate, (f(t + h).value - f(t - h).value) / (2 * h), {.absolute = margin}));
  CHECK(near(f(t).acceleration, (f(t + h).rate - f(t - h).rate) / (2 * h), {.absolute = 10 * margin}));
}

}  // namespace

TEST_CASE("a step rises smoothly from one value to the other, and is constant before and after") {
  const auto f = [](Real t) { return step_function(2, -1, 0.5, 0.8, t); };
  for (const Real t : {-1.0, 0.0, 0.5}) {
    CHECK(f(t).value == 2);
    CHECK(f(t).rate == 0);
    CHECK(f(t).acceleration == 0);
  }
  for (const Real t : {0.8, 1.0, 50.0}) {
    CHECK(f(t).value == -1);
    CHECK(f(t).rate == 0);
    CHECK(f(t).acceleration == 0);
  }
  CHECK(f(0.65).value == 0.5);
  CHECK(near(f(0.65).rate, -3 / 0.3 * 30.0 / 16, {.relative = kRoundOff}));
  CHECK(f(0.65).acceleration == 0);
  for (int i = 1; i < 30; ++i) check_derivatives(f, 0.5 + 0.01 * i, 3e-7);
  // Class C2: rate and acceleration vanish towards the ends as s^2 and s.
  for (const Real t : {0.5 + 1e-6, 0.8 - 1e-6}) {
    CHECK(std::abs(f(t).rate) < 1e-8);
    CHECK(std::abs(f(t).acceleration) < 1e-2);
    CHECK(std::abs(f(t).acceleration) > 1e-4);
  }
}

TEST_CASE("an eased ramp is constant, speeds up smoothly, and continues at its rate") {
  const auto f = [](Real t) { return eased_ramp_function(2, -3, 0.5, 0.75, t); };
  for (const Real t : {-1.0, 0.0, 0.5}) {
    CHECK(f(t).value == 2);
    CHECK(f(t).rate == 0);
    CHECK(f(t).acceleration == 0);
  }
  for (const Real t : {0.75, 1.0, 50.0}) {
    CHECK(f(t).value == 2 - 3 * (t - 0.625));
    CHECK(f(t).rate == -3);
    CHECK(f(t).acceleration == 0);
  }
  CHECK(f(0.625).rate == -1.5);
  CHECK(f(0.625).acceleration == -3 / 0.25 * 1.5);
  for (int i = 1; i < 25; ++i) check_derivatives(f, 0.5 + 0.01 * i, 3e-8);
  // Class C2: value and rate are matched at both ends, and the acceleration vanishes there as s.
  for (const Real t : {0.5, 0.75}) {
    const TimeValue before = f(t - 1e-9), after = f(t + 1e-9);
    CHECK(near(before.value, after.value, {.absolute = 1e-8}));
    CHECK(near(before.rate, after.rate, {.absolute = 1e-12}));
    CHECK(std::abs(before.acceleration) + std::abs(after.acceleration) < 1e-6);
    CHECK(std::abs(before.acceleration) + std::abs(after.acceleration) > 1e-8);
  }
}

TEST_CASE("a step never leaves the range of its two values") {
  Real last = 0.1;
  for (int i = 0; i <= 100000; ++i) {
    const TimeValue at = step_function(0.1, 0.7, 0.2, 0.9, 1e-5 * i);
    if (at.value < last || at.value > 0.7 || at.rate < 0) FAIL("it falls at " << 1e-5 * i);
    last = at.value;
  }
  CHECK(last == 0.7);
}

TEST_CASE("a quintic has the values, rates and second derivatives of its two ends") {
  const QuinticSegment q{1, 3, 2, -1, 0.5, -2, 4, 1};
  const auto f = [&](Real t) { return quintic_function(q, t); };
  CHECK(f(1).value == 2);
  CHECK(f(1).rate == 0.5);
  CHECK(f(1).acceleration == 4);
  CHECK(f(3).value == -1);
  CHECK(f(3).rate == -2);
  CHECK(f(3).acceleration == 1);
  for (const Real t : {1.1, 1.7, 2.0, 2.9}) check_derivatives(f, t, 1e-9);
  // Polynomials of degree 5 are reproduced: t^5 on [1, 2].
  const QuinticSegment power{1, 2, 1, 32, 5, 80, 20, 160};
  for (const Real t : {1.2, 1.5, 1.9})
    CHECK(near(quintic_function(power, t).value, std::pow(t, 5), {.relative = kRoundOff}));
}

}  // namespace scree
