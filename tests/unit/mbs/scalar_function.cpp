#include "mbs/scalar_function.hpp"

#include <cmath>
#include <string>

#include "base/error.hpp"
#include "support/catch.hpp"

using namespace scree;

namespace {

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

// The function's rate and acceleration against differences of its value and rate.
void check_derivatives(const ScalarFunction& f, Real t) {
  constexpr Real kStep = 1e-5;
  CAPTURE(t);
  CHECK(f(t).rate == Approx((f(t + kStep).value - f(t - kStep).value) / (2 * kStep)).margin(1e-8));
  CHECK(f(t).acceleration == Approx((f(t + kStep).rate - f(t - kStep).rate) / (2 * kStep)).margin(1e-7));
}

}  // namespace

TEST_CASE("ramp and sine have the derivatives they state") {
  TimeFunction ramp;
  ramp.kind = TimeFunction::Kind::ramp;
  ramp.value = 2;
  ramp.rate = -3;
  CHECK(ScalarFunction(ramp, "f", 1)(0.5).value == 0.5);
  check_derivatives(ScalarFunction(ramp, "f", 1), 0.5);
  TimeFunction sine;
  sine.kind = TimeFunction::Kind::sine;
  sine.value = 1;
  sine.amplitude = 0.5;
  sine.frequency = 0.25;
  sine.phase = 0.3;
  CHECK(ScalarFunction(sine, "f", 1)(1).value == Approx(1 + 0.5 * std::sin(M_PI / 2 + 0.3)));
  check_derivatives(ScalarFunction(sine, "f", 1), 0.7);
}

TEST_CASE("a table is interpolated by the natural cubic spline") {
  const ScalarFunction f(table({0, 0.5, 0.8, 2}, {1, -1, 3, 2}), "f", 2);
  const Real times[] = {0, 0.5, 0.8, 2}, values[] = {1, -1, 3, 2};
  for (int i = 0; i < 4; ++i) CHECK(f(times[i]).value == Approx(values[i]));
  for (const Real t : {0.2, 0.6, 0.79, 1.4}) check_derivatives(f, t);
  for (const Real t : {0.5, 0.8}) {
    CHECK(f(t - 1e-9).rate == Approx(f(t + 1e-9).rate));
    CHECK(f(t - 1e-9).acceleration == Approx(f(t + 1e-9).acceleration).epsilon(1e-6));
  }
  CHECK(f(0).acceleration == Approx(0).margin(1e-12));
  CHECK(f(2).acceleration == Approx(0).margin(1e-12));
  CHECK(f(2 + 1e-9).value == Approx(2 + 1e-9 * f(2).rate));
  // A straight line stays one.
  const ScalarFunction line(table({0, 1, 3}, {0, 2, 6}), "f", 3);
  CHECK(line(2.2).value == Approx(4.4));
  CHECK(line(2.2).acceleration == Approx(0).margin(1e-12));
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
  const auto linear = [](const TimeFunction& function) {
    return ScalarFunction(function, "f", 1, Interpolation::linear);
  };
  const TimeFunction first = table({0, 1, 2}, {0, 3, 1}), longer = table({0, 1, 2, 3}, {0, 3, 1, 7}),
                     bent = table({0, 1, 2}, {0, 3, 2});
  CHECK(linear(first).same_until(linear(longer), 2));
  CHECK(linear(longer).same_until(linear(first), 1.5));
  CHECK_FALSE(linear(first).same_until(linear(longer), 2.1));
  CHECK_FALSE(linear(longer).same_until(linear(first), 2.1));
  CHECK(linear(first).same_until(linear(bent), 1));
  CHECK_FALSE(linear(first).same_until(linear(bent), 1.1));
  CHECK(linear(first).same_until(linear(first), 5));
  // The natural spline through more points is another one from the start.
  CHECK_FALSE(ScalarFunction(first, "f", 2).same_until(ScalarFunction(longer, "f", 2), 0.5));
  TimeFunction ramp;
  ramp.kind = TimeFunction::Kind::ramp;
  CHECK_FALSE(linear(first).same_until(linear(ramp), 0));
  TimeFunction steeper = ramp;
  steeper.rate = 1;
  CHECK_FALSE(linear(ramp).same_until(linear(steeper), 0));
  CHECK(linear(ramp).same_until(linear(ramp), 1));
}
