// Efforts of steps with events in a joint law: their derivatives, wherever in the step the event is, and a
// motor's integral.
#include <cmath>
#include <memory>
#include <random>

#include "mbs/joint_laws.hpp"
#include "mbs/limited_line.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

using namespace scree;

namespace {

class Numbers {
 public:
  Real operator()(Real low, Real high) { return std::uniform_real_distribution<Real>(low, high)(random_); }

 private:
  std::mt19937 random_{7};
};

JointFriction any_friction(Numbers& number, bool stribeck) {
  JointFriction friction;
  friction.effort = number(0, 2), friction.lever = number(0, 1);
  friction.stiffness = number(1, 100), friction.damping = number(0, 10);
  if (stribeck) friction.static_ratio = number(1, 3), friction.stribeck_rate = 2;
  return friction;
}

Motor any_motor(Numbers& number, bool integrates) {
  Motor motor;
  motor.kind = MotorKind::speed, motor.limit = number(0.5, 3);
  motor.gain = number(0.1, 3), motor.integral_gain = integrates ? number(0, 5) : 0;
  motor.rate.kind = TimeFunction::Kind::sine;
  motor.rate.value = number(-2, 2), motor.rate.amplitude = 1, motor.rate.frequency = 0.5;
  return motor;
}

Motor any_servo(Numbers& number) {
  Motor motor = any_motor(number, false);
  motor.kind = MotorKind::position, motor.position = motor.rate;
  motor.position_gain = number(0.1, 5), motor.rate_gain = number(0, 3);
  return motor;
}

// A step consistent with the method: with the mean of the rates.
LawStep any_step(Numbers& number, Real memory) {
  LawStep step{{0.3, number(-1, 1), number(-2, 2), number(0, 5)}, memory, number(1e-3, 0.3)};
  step.start.second = number(-20, 20);
  return step;
}
CoordinateInstant end_of(const LawStep& step, Numbers& number) {
  CoordinateInstant end{step.start.time + step.h, 0, 0, number(0, 5)};
  end.rate = step.start.rate + step.h * step.start.second * number(0.5, 1.5);
  end.value = step.start.value + step.h / 2 * (step.start.rate + end.rate);
  return end;
}

void check_derivatives(const JointLaw& law, const LawStep& step, const CoordinateInstant& end) {
  constexpr Real kHalf = 1e-7;
  const auto slope = [&](Real CoordinateInstant::*by) {
    CoordinateInstant before = end, after = end;
    before.*by -= kHalf, after.*by += kHalf;
    return (law.step_effort(step, after).effort - law.step_effort(step, before).effort) / (2 * kHalf);
  };
  const JointEffort effort = law.step_effort(step, end);
  REQUIRE(near(effort.by_value, slope(&CoordinateInstant::value), {.relative = 1e-4, .absolute = 1e-4}));
  REQUIRE(near(effort.by_rate, slope(&CoordinateInstant::rate), {.relative = 1e-4, .absolute = 1e-4}));
  REQUIRE(near(effort.by_load, slope(&CoordinateInstant::load), {.relative = 1e-4, .absolute = 1e-4}));
}

}  // namespace

TEST_CASE("the effort of a step is a continuous function of its end, with these derivatives") {
  Numbers number;
  for (int i = 0; i < 20000; ++i) {
    const std::unique_ptr<JointLaw> friction = make_joint_law(any_friction(number, i % 3 == 0));
    const LawStep step = any_step(number, number(-6, 6));
    check_derivatives(*friction, step, end_of(step, number));
    const std::unique_ptr<JointLaw> motor = make_joint_law(any_motor(number, i % 5 != 0), 10);
    const LawStep other = any_step(number, number(-2, 2));
    check_derivatives(*motor, other, end_of(other, number));
  }
  for (int i = 0; i < 5000; ++i) {
    const std::unique_ptr<JointLaw> servo = make_joint_law(any_servo(number), 10);
    const LawStep step = any_step(number, 0);
    check_derivatives(*servo, step, end_of(step, number));
  }
}

TEST_CASE("the mean of a line between limits is that of many points") {
  Numbers number;
  for (int i = 0; i < 200; ++i) {
    const Real a = number(-3, 3), b = number(-3, 3), first = number(0, 2), last = number(0, 2);
    constexpr int kPoints = 4000;
    Real sum = 0;
    for (int k = 0; k < kPoints; ++k) {
      const Real s = (k + 0.5) / kPoints, limit = first + s * (last - first);
      sum += std::max(-limit, std::min(a + s * (b - a), limit));
    }
    REQUIRE(near(limited_mean(a, b, first, last).value, sum / kPoints, {.absolute = 1e-6}));
  }
}

TEST_CASE("a motor's integral grows over the part of a step in which the limit does not act") {
  const Real h = 0.1;
  // c'' = 2 while the motor is at its limit: e falls from e_0 to e_0 - 0.2. P = 1, T <= 3.
  const auto after = [&](Real integral_gain, Real error, Real memory) {
    Motor motor;
    motor.kind = MotorKind::speed, motor.gain = 1, motor.integral_gain = integral_gain, motor.limit = 3;
    motor.rate.value = 4;
    const LawStep step{{0, 0, 4 - error, 0, 2}, memory, h};
    const Real rate = 4 - error + 2 * h;
    return make_joint_law(motor, 10)->memory_after(step, {h, h / 2 * (step.start.rate + rate), rate});
  };
  CHECK(after(0.5, 3.4, 0.1) == 0.1);                                   // held to the end, bit for bit
  CHECK(near(after(0.5, 2, 0.1), 0.1 + h * 1.9, {.absolute = 1e-14}));  // never at the limit
  // P e + I z = 3 is left at e = 2.9, after a quarter of the step: I e = 1.45 < P c''.
  CHECK(near(after(0.5, 2.95, 0.2), 0.2 + 0.075 * (2.9 + 2.75) / 2, {.absolute = 1e-14}));
  // With I e = 5.8 > P c'' z follows the limit: P e_1 + I z_1 = 3.
  CHECK(near(after(2, 2.95, 0.05), (3 - 2.75) / 2, {.absolute = 1e-14}));
  // The limit is reached from below, within the step.
  CHECK(near(after(2, 2.8, 0.05), (3 - 2.6) / 2, {.absolute = 1e-14}));
  // Until I e falls to P c'' at e = 1, after half the step; then 3 - 1 = I z, which grows by e from there.
  CHECK(near(after(2, 1.1, 0.95), 1 + 0.05 * (1 + 0.9) / 2, {.absolute = 1e-14}));
}
