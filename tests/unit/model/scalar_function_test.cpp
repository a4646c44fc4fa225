#include "model/derived/scalar_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <random>
#include <string>

#include "base/error.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

using namespace scree;

namespace {

constexpr Real kRoundOff = 4 * kUlp;

TimeFunction table(std::vector<Real> times, std::vector<Real> values) {
  TimeFunction function;
  function.kind = TimeFunction::Kind::table;
  function.times = std::move(times);
  function.values = std::move(values);
  return function;
}

std::string refusal(const TimeFunction& function, Real end) {
  try {
    const ScalarFunction refused(function, "driver 'crank'", end);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TimeFunction monotone_table(std::vector<Real> times, std::vector<Real> values) {
  TimeFunction function = table(std::move(times), std::move(values));
  function.interpolation = Interpolation::monotone;
  return function;
}

// Checks that rate and acceleration do not jump.
void check_smooth(const ScalarFunction& f, std::initializer_list<Real> points) {
  constexpr Real kShort = 1e-9;
  constexpr Real kTurn = 3e-8;  // relative change of the acceleration in that time
  for (const Real t : points) {
    const TimeValue before = f(t - kShort), after = f(t + kShort);
    CHECK(near(after.rate - before.rate, 2 * kShort * f(t).acceleration, {.absolute = 32 * kRoundOff}));
    CHECK(near(before.acceleration, after.acceleration, {.relative = kTurn}));
  }
}

// The function's rate and acceleration against differences of its value and rate.
void check_derivatives(const ScalarFunction& f, Real t) {
  constexpr Real kStep = 1e-5;
  // Truncation of central differences is this times the next derivative but one; of all functions here at
  // most:
  constexpr Real kTruncation = kStep * kStep / 6, kThird = 4e3, kFourth = 1e5;
  CAPTURE(t);
  CHECK(near(f(t).rate, (f(t + kStep).value - f(t - kStep).value) / (2 * kStep),
             {.absolute = kTruncation * kThird}));
  CHECK(near(f(t).acceleration, (f(t + kStep).rate - f(t - kStep).rate) / (2 * kStep),
             {.absolute = kTruncation * kFourth}));
}

}  // namespace

TEST_CASE("ramp and sine have the derivatives they state") {
  TimeFunction ramp;
  ramp.kind = TimeFunction::Kind::ramp;
  ramp.value = 2;
  ramp.rate = -3;
  CHECK(ScalarFunction(ramp, "f", 1)(0.5).value == 0.5);
  check_derivatives(ScalarFunction(ramp, "f", 1), 0.5);
  ramp.start = 0.25;
  ramp.end = 0.75;
  const ScalarFunction eased(ramp, "f", 1);
  CHECK(eased(0.25).value == 2);
  CHECK(eased(1).value == 0.5);
  for (const Real t : {0.1, 0.4, 0.6, 0.9}) check_derivatives(eased, t);
  check_smooth(eased, {0.5});
  TimeFunction sine;
  sine.kind = TimeFunction::Kind::sine;
  sine.value = 1;
  sine.amplitude = 0.5;
  sine.frequency = 0.25;
  sine.phase = 0.3;
  CHECK(near(ScalarFunction(sine, "f", 1)(1).value, 1 + 0.5 * std::sin(M_PI / 2 + 0.3),
             {.relative = kRoundOff}));
  check_derivatives(ScalarFunction(sine, "f", 1), 0.7);
}

TEST_CASE("a table is interpolated by the natural cubic spline") {
  const ScalarFunction f(table({0, 0.5, 0.8, 2}, {1, -1, 3, 2}), "f", 2);
  const Real times[] = {0, 0.5, 0.8, 2}, values[] = {1, -1, 3, 2};
  for (int i = 0; i < 4; ++i) CHECK(f(times[i]).value == values[i]);
  for (const Real t : {0.2, 0.6, 0.79, 1.4}) check_derivatives(f, t);
  check_smooth(f, {0.5, 0.8});
  CHECK(f(0).acceleration == 0);
  CHECK(f(2).acceleration == 0);
  CHECK(near(f(2 + 1e-9).value, 2 + 1e-9 * f(2).rate, {.relative = kRoundOff}));
  // A straight line stays one.
  const ScalarFunction line(table({0, 1, 3}, {0, 2, 6}), "f", 3);
  CHECK(near(line(2.2).value, 4.4, {.relative = kRoundOff}));
  CHECK(line(2.2).acceleration == 0);
}

TEST_CASE("a clamped spline has the given rates at its ends and is twice continuously differentiable") {
  TimeFunction function = table({0, 0.5, 0.8, 2}, {1, -1, 3, 2});
  function.interpolation = Interpolation::clamped;
  for (const std::array<Real, 2> rates : {std::array<Real, 2>{0, 0}, {-3, 0.5}}) {
    function.end_rates = rates;
    const ScalarFunction f(function, "f", 2);
    CHECK(f(0).rate == rates[0]);
    CHECK(near(f(2).rate, rates[1], {.absolute = 4 * kRoundOff}));
    for (std::size_t i = 0; i < 4; ++i) CHECK(f(function.times[i]).value == function.values[i]);
    for (const Real t : {0.2, 0.6, 0.79, 1.4}) check_derivatives(f, t);
    check_smooth(f, {0.5, 0.8});
  }
  // Two points: the cubic of Hermite.
  TimeFunction two = table({0, 1}, {0, 1});
  two.interpolation = Interpolation::clamped;
  CHECK(near(ScalarFunction(two, "f", 1)(0.25).value, 0.25 * 0.25 * (3 - 2 * 0.25), {.relative = kRoundOff}));
}

TEST_CASE("a motion that holds and then moves: monotone holds, the splines do not") {
  const std::vector<Real> times{0, 0.5, 0.8, 1.5}, values{0, 0, 1.5, 1.5};
  const ScalarFunction natural(table(times, values), "f", 1.5);
  CHECK(near(natural(0).rate, -1.85, {.absolute = 0.005}));
  const ScalarFunction f(monotone_table(times, values), "f", 1.5);
  for (int i = 0; i <= 500; ++i) {
    for (const Real t : {1e-3 * i, 0.8 + 1.4e-3 * i}) {
      CAPTURE(t);
      CHECK(f(t).value == (t <= 0.5 ? 0 : 1.5));
      CHECK(f(t).rate == 0);
      CHECK(f(t).acceleration == 0);
    }
  }
  // Between the points it is the smooth step.
  for (const Real t : {0.55, 0.6, 0.7}) {
    CHECK(near(f(t).value, step_function(0, 1.5, 0.5, 0.8, t).value, {.relative = kRoundOff}));
    CHECK(near(f(t).acceleration, step_function(0, 1.5, 0.5, 0.8, t).acceleration,
               {.relative = 4 * kRoundOff}));
    check_derivatives(f, t);
  }
}

TEST_CASE("monotone tables never overshoot, are twice continuously differentiable, and are local") {
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> uniform(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Real> times{0}, values{0};
    for (int i = 1; i < 12; ++i) {
      times.push_back(times.back() + std::pow(10, -2 * uniform(random)));
      const Real rise = std::pow(10, -3 * uniform(random));
      values.push_back(values.back() + (uniform(random) < 0.2 ? 0 : uniform(random) < 0.3 ? -rise : rise));
    }
    const ScalarFunction f(monotone_table(times, values), "f", times.back());
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      const Real low = std::min(values[i], values[i + 1]), high = std::max(values[i], values[i + 1]);
      const Real sign = values[i + 1] < values[i] ? -1 : 1;
      for (int k = 0; k <= 200; ++k) {
        const Real t = times[i] + (times[i + 1] - times[i]) * k / 200;
        const TimeValue at = f(t);
        const Real slope = (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
        CAPTURE(trial, i, k);
        REQUIRE(at.value >= low - 1e-14);
        REQUIRE(at.value <= high + 1e-14);
        if (k < 200) REQUIRE(sign * at.rate >= -1e-13 * (1 + std::abs(slope)));
      }
      // A smooth step by 1 in 1 s has accelerations of up to 5.8 and changes them by up to 60 per second;
      // with rates at its ends somewhat larger ones.
      const Real nearly = 1e-9 * (times[i + 1] - times[i]);
      const TimeValue before = f(times[i + 1] - nearly), after = f(times[i + 1]);
      const Real steep = 1 + std::abs(values[i + 1] - values[i]) / (times[i + 1] - times[i]);
      CHECK(near(before.rate, after.rate, {.absolute = 2e-8 * steep}));
      CHECK(near(before.acceleration, after.acceleration,
                 {.absolute = 1.5e-7 * steep / (times[i + 1] - times[i])}));
    }
    // Points after the next one do not matter.
    std::vector<Real> changed = values;
    changed[8] += 3;
    changed.pop_back();
    std::vector<Real> fewer(times.begin(), times.end() - 1);
    const ScalarFunction g(monotone_table(fewer, changed), "f", fewer.back());
    for (int k = 0; k < 100; ++k) {
      const Real t = times[6] * k / 100;
      REQUIRE(f(t).value == g(t).value);
      REQUIRE(f(t).acceleration == g(t).acceleration);
    }
  }
}

TEST_CASE("how far a spline leaves the values at its points") {
  TimeFunction hold = table({0, 1, 2, 3}, {0, 0, 1, 1});
  const ScalarFunction natural(hold, "hold", 3);
  const Overshoot found = natural.overshoot();
  Real lowest = 0, highest = 0;
  for (int i = 0; i <= 3000; ++i) {
    const Real value = natural(Real(i) / 1000).value;
    lowest = std::min(lowest, value), highest = std::max(highest, value - 1);
  }
  CHECK(std::abs(found.beyond) >= std::max(-lowest, highest));
  CHECK(std::abs(found.beyond) < 1.00001 * std::max(-lowest, highest));
  CHECK(natural(found.t).value == found.value);
  CHECK(std::abs(natural(found.t).rate) < kRoundOff);
  CHECK(ScalarFunction(table({0, 1, 2}, {0, 1, 2}), "line", 2).overshoot().beyond == 0);
  hold.interpolation = Interpolation::monotone;
  CHECK(ScalarFunction(hold, "hold", 3).overshoot().beyond == 0);
}

TEST_CASE("tables of smooth data: the error's order") {
  // Errors for sin t on [0, 1.2], where it rises: the largest in the middle of the segments.
  const auto error = [](Interpolation interpolation, int segments) {
    std::vector<Real> times, values;
    for (int i = 0; i <= segments; ++i) {
      times.push_back(1.2 * i / segments);
      values.push_back(std::sin(times.back()));
    }
    TimeFunction function = table(times, values);
    function.interpolation = interpolation;
    function.end_rates = {1, std::cos(1.2)};
    const ScalarFunction f(function, "f", 1.2);
    Real largest = 0;
    for (int i = 0; i < segments; ++i) {
      const Real t = 1.2 * (i + 0.37) / segments;
      largest = std::max(largest, std::abs(f(t).value - std::sin(t)));
    }
    return largest;
  };
  const auto order = [&](Interpolation interpolation) {
    return std::log2(error(interpolation, 40) / error(interpolation, 80));
  };
  CHECK(near(order(Interpolation::linear), 2, {.absolute = 0.015}));
  CHECK(near(order(Interpolation::natural), 2, {.absolute = 5e-4}));  // the second derivative at 1.2 is not 0
  CHECK(near(order(Interpolation::clamped), 4, {.absolute = 1.2e-3}));
  CHECK(near(order(Interpolation::monotone), 3, {.absolute = 1.2e-3}));
}

TEST_CASE("a linear table is made of straight lines, and a step holds before and after") {
  TimeFunction function = table({0, 1, 3}, {0, 2, -1});
  function.interpolation = Interpolation::linear;
  const ScalarFunction f(function, "f", 3);
  CHECK(f(0.5).value == 1);
  CHECK(f(2).value == 0.5);
  CHECK(f(2).rate == -1.5);
  CHECK(f(2).acceleration == 0);
  TimeFunction step;
  step.kind = TimeFunction::Kind::step;
  step.value = 1;
  step.end_value = 4;
  step.start = 0.25;
  step.end = 0.75;
  const ScalarFunction g(step, "g", 1);
  CHECK(g(0.25).value == 1);
  CHECK(g(0.5).value == 2.5);
  CHECK(g(0.75).value == 4);
  for (const Real t : {0.3, 0.5, 0.6}) check_derivatives(g, t);
}

TEST_CASE("tables that cannot be used are refused by the owner's name") {
  CHECK(refusal(table({0}, {1}), 1).find("driver 'crank'") != std::string::npos);
  CHECK(refusal(table({0, 1}, {1}), 1).find("2 times and 1 values") != std::string::npos);
  CHECK(refusal(table({0, 1, 1}, {1, 2, 3}), 1).find("must increase") != std::string::npos);
  CHECK(refusal(table({0, 0.9}, {1, 2}), 1).find("0 s to 1 s") != std::string::npos);
  CHECK(refusal(table({0.1, 2}, {1, 2}), 1).find("0.1 s to 2 s") != std::string::npos);
  CHECK(refusal(table({-1, 2}, {1, 2}), 1).empty());
}

TEST_CASE("functions are the same until a time where no value before it differs in a bit") {
  const auto with = [](Interpolation interpolation, TimeFunction function) {
    function.interpolation = interpolation;
    return ScalarFunction(function, "f", 1);
  };
  const auto linear = [&](const TimeFunction& function) { return with(Interpolation::linear, function); };
  const TimeFunction first = table({0, 1, 2}, {0, 3, 1}), longer = table({0, 1, 2, 3}, {0, 3, 1, 7}),
                     bent = table({0, 1, 2}, {0, 3, 2});
  CHECK(linear(first).same_until(linear(longer), 2));
  CHECK(linear(longer).same_until(linear(first), 1.5));
  CHECK_FALSE(linear(first).same_until(linear(longer), 2.1));
  CHECK_FALSE(linear(longer).same_until(linear(first), 2.1));
  CHECK(linear(first).same_until(linear(bent), 1));
  CHECK_FALSE(linear(first).same_until(linear(bent), 1.1));
  CHECK(linear(first).same_until(linear(first), 5));
  CHECK_FALSE(linear(first).same_until(with(Interpolation::monotone, first), 0.5));
  // The natural spline through more points differs from the start; the monotone one is local.
  CHECK_FALSE(with(Interpolation::natural, first).same_until(with(Interpolation::natural, longer), 0.5));
  CHECK(with(Interpolation::monotone, first).same_until(with(Interpolation::monotone, longer), 1));
  CHECK_FALSE(with(Interpolation::monotone, first).same_until(with(Interpolation::monotone, longer), 1.1));
  for (const auto change : {&TimeFunction::value, &TimeFunction::rate, &TimeFunction::end_value,
                            &TimeFunction::start, &TimeFunction::end}) {
    TimeFunction step, other;
    step.kind = other.kind = TimeFunction::Kind::step;
    other.*change = 1;
    CHECK_FALSE(linear(step).same_until(linear(other), 0));
    CHECK(linear(other).same_until(linear(other), 1));
    CHECK_FALSE(linear(first).same_until(linear(step), 0));
  }
}
