// Laws of motors on joints.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mbs/integral.hpp"
#include "mbs/joint_laws.hpp"
#include "mbs/limited_line.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

namespace {

// A motor at its limit is there but for round-off.
constexpr Real kAtLimit = 1 - 1e-12;
// Halvings of an interval of length 1, down to round-off.
constexpr int kHalvings = 52;

// The first s in [0, 1] at which a + b s + c s^2, with a >= 0, falls below 0; 1 if there is none.
Real first_root(Real a, Real b, Real c) {
  const Real square = b * b - 4 * a * c;
  const bool falls = b < 0 || (c < 0 && a == 0);
  if (square < 0 || (!falls && c >= 0)) return 1;
  // The other root, which has no cancellation, gives this one.
  const Real q = -(b + std::copysign(std::sqrt(square), b)) / 2;
  Real least = 1;
  for (const Real root : {q != 0 ? a / q : Real(0), c != 0 ? q / c : Real(1)})
    if (root > 0 || (root == 0 && b < 0)) least = std::min(least, root);
  return least;
}

// The mean effort of a step is that of the straight line between the unlimited efforts at its ends, clipped
// to the limit. The trapezoidal rule gives it where the end of the step has twice the mean less the effort
// at the start. A limit that is reached or left within a step thus counts from that instant on, and a step
// without such an event is unchanged.
class MotorLaw : public JointLaw {
 public:
  explicit MotorLaw(Real limit) : limit_(limit) {}
  bool drives() const final { return true; }
  bool resolves_events() const final { return std::isfinite(limit_); }

 protected:
  JointEffort limited(const JointEffort& wanted) const {
    if (std::abs(wanted.effort) <= limit_) return wanted;
    return {std::copysign(limit_, wanted.effort), 0, 0, limit_};
  }
  // first, last: unlimited efforts at the ends of the step.
  JointEffort limited_step(Real first, const Dual& last, Real size) const {
    if (std::abs(first) <= limit_ && std::abs(last.value) <= limit_)
      return {last.value, last.by_value, last.by_rate, size};
    return of_mean(first, limited_mean(first, last, limit_, limit_));
  }
  JointEffort of_mean(Real first, const Dual& mean) const {
    const Dual effort = 2 * mean - std::clamp(first, -limit_, limit_);
    return {effort.value, effort.by_value, effort.by_rate, limit_};
  }
  Real limit_;
};

// T = effort(t)
class EffortMotor final : public MotorLaw {
 public:
  EffortMotor(const Motor& motor, const std::string& owner, Real end)
      : MotorLaw(motor.limit), effort_(motor.effort, owner, end) {}
  JointEffort effort(const CoordinateInstant& at, Real) const override {
    const Real effort = effort_(at.time).value;
    return limited({effort, 0, 0, std::abs(effort)});
  }
  JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const override {
    const Real last = effort_(end.time).value;
    return limited_step(effort_(step.start.time).value, last, std::abs(last));
  }

 private:
  ScalarFunction effort_;
};

// Without its limit the effort is linear in c and c', with constant slopes.
class LinearMotor : public MotorLaw {
 public:
  LinearMotor(Real limit, Real by_value, Real by_rate)
      : MotorLaw(limit), by_value_(by_value), by_rate_(by_rate) {}
  JointEffort effort(const CoordinateInstant& at, Real) const final {
    return limited({wanted(at), by_value_, by_rate_, size(at)});
  }
  JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const final {
    const Dual last{wanted(end), by_value_, by_rate_, 0};
    JointEffort effort = limited_step(wanted(step.start), last, size(end));
    effort.wanted = last;
    return effort;
  }
  Real limit() const final { return limit_; }
  Real limited_at(const LawStep& step, Real last) const final {
    return limited_step(wanted(step.start), last, 0).effort;
  }

 protected:
  virtual Real wanted(const CoordinateInstant& at) const = 0;  // the unlimited effort
  virtual Real size(const CoordinateInstant& at) const = 0;    // its largest contribution

 private:
  Real by_value_, by_rate_;
};

// T = T_s (u(t) - c'/w_f)
class LineMotor final : public LinearMotor {
 public:
  LineMotor(const Motor& motor, const std::string& owner, Real end)
      : LinearMotor(motor.limit, 0, -motor.stall_effort / motor.free_rate),
        stall_effort_(motor.stall_effort),
        slope_(-motor.stall_effort / motor.free_rate),
        command_(motor.command, owner, end) {}

 private:
  Real wanted(const CoordinateInstant& at) const override { return driven(at) + slope_ * at.rate; }
  Real size(const CoordinateInstant& at) const override {
    return std::max(std::abs(driven(at)), std::abs(slope_ * at.rate));
  }
  Real driven(const CoordinateInstant& at) const { return stall_effort_ * command_(at.time).value; }
  Real stall_effort_, slope_;
  ScalarFunction command_;
};

// T = P e + D e', e = r(t) - c
class PositionMotor final : public LinearMotor {
 public:
  PositionMotor(const Motor& motor, const std::string& owner, Real end)
      : LinearMotor(motor.limit, -motor.position_gain, -motor.rate_gain),
        gain_(motor.position_gain),
        rate_gain_(motor.rate_gain),
        position_(motor.position, owner, end) {}
  Real stiffness() const override { return gain_; }

 private:
  Real wanted(const CoordinateInstant& at) const override {
    const TimeValue position = position_(at.time);
    return gain_ * (position.value - at.value) + rate_gain_ * (position.rate - at.rate);
  }
  Real size(const CoordinateInstant& at) const override {
    const TimeValue position = position_(at.time);
    return std::max({gain_ * std::abs(position.value - at.value), rate_gain_ * std::abs(position.rate),
                     rate_gain_ * std::abs(at.rate)});
  }
  Real gain_, rate_gain_;
  ScalarFunction position_;
};

// T = P e + I z, e = w(t) - c', z the integral of e: over a step the integral of w less the change of c.
// While T is at the limit, z is held where e would drive it further (anti-windup); where e falls so fast
// that T would leave the limit, z grows just fast enough to keep T there. Both count over the part of a step
// in which they hold.
class SpeedMotor final : public MotorLaw {
 public:
  SpeedMotor(const Motor& motor, const std::string& owner, Real end)
      : MotorLaw(motor.limit),
        gain_(motor.gain),
        integral_gain_(motor.integral_gain),
        rate_(motor.rate, owner, end) {}

  JointEffort effort(const CoordinateInstant& at, Real memory) const override {
    return limited({wanted(at, memory), -integral_gain_, -gain_, size(at, memory)});
  }
  JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const override {
    const Real first = wanted(step.start, step.memory);
    const Over o = over(step, end);
    if (o.held) return of_mean(first, o.mean);
    return limited_step(first, wanted(end, o.integral), size(end, o.integral.value));
  }
  bool has_memory() const override { return true; }
  bool needs_second() const override { return std::isfinite(limit_); }
  Real memory_after(const LawStep& step, const CoordinateInstant& end) const override {
    return over(step, end).integral.value;
  }

 private:
  // Errors of the step in units of e, positive towards the limit: at its ends, and at the fraction s of the
  // step, e_0 + h e_0' s + h^2 w''/2 s^2 with c'' as at the start.
  struct Errors {
    Real first, slope, curvature;  // e_0, h e_0', h^2 w''/2 of the parabola through the wanted rates
    Dual last;
    Real h;
    Real at(Real s) const { return first + s * (slope + s * curvature); }
  };
  Errors errors(const LawStep& step, const CoordinateInstant& end, Real side) const {
    const TimeValue wanted = rate_(step.start.time);
    const Real rise = step.h * wanted.rate, curvature = rate_(end.time).value - wanted.value - rise;
    return {side * error(step.start), side * (rise - step.h * step.start.second), side * curvature,
            side * end_error(end), step.h};
  }
  Real error(const CoordinateInstant& at) const { return rate_(at.time).value - at.rate; }
  Dual end_error(const CoordinateInstant& end) const { return {error(end), 0, -1, 0}; }
  Real size(const CoordinateInstant& at, Real memory) const {
    return std::max({gain_ * std::abs(rate_(at.time).value), gain_ * std::abs(at.rate),
                     integral_gain_ * std::abs(memory)});
  }
  // The effort T without its limit.
  Real wanted(const CoordinateInstant& at, Real z) const { return gain_ * error(at) + integral_gain_ * z; }
  Dual wanted(const CoordinateInstant& end, const Dual& z) const {
    return gain_ * end_error(end) + integral_gain_ * z;
  }
  // z at the end of the step, and the mean of T where the limit takes part.
  struct Over {
    Dual integral;
    bool held = false;
    Dual mean{};
  };
  Over over(const LawStep& step, const CoordinateInstant& end) const;
  // The fraction of a step at which T leaves the limit, and whether z follows it until then.
  struct Release {
    Real fraction;
    bool follows;
  };
  Release release_of(Real memory, const Errors& e) const;
  Dual released(const Release& release, Real memory, const Errors& e) const;
  // The z with which T is just at the limit at the end of the step.
  Dual at_limit(const Errors& e) const { return (limit_ - gain_ * e.last) / integral_gain_; }
  Dual error_at(const Dual& fraction, const Errors& e) const;
  Dual held_after(const Dual& last, const Errors& e) const;

  Real gain_, integral_gain_;
  ScalarFunction rate_;
};

SpeedMotor::Over SpeedMotor::over(const LawStep& step, const CoordinateInstant& end) const {
  const Dual all{step.memory + integral(rate_, step.start.time, end.time) - (end.value - step.start.value),
                 -1, 0, 0};
  const Real first = wanted(step.start, step.memory);
  const Dual last = wanted(end, all);
  const Over plain{all};
  if (!needs_second() || step.h == 0) return plain;
  if (std::abs(first) >= kAtLimit * limit_) {
    const Real side = std::copysign(Real(1), first);
    const Errors e = errors(step, end, side);
    if (!(e.first > 0)) return plain;
    const Release release = release_of(side * step.memory, e);
    const Dual z = step.memory + side * released(release, side * step.memory, e), then = wanted(end, z);
    if (release.fraction == 1) return {z, true, limited_mean(first, then, limit_, limit_)};
    return {z, true,
            side * (release.fraction * limit_) +
                0.5 * (1 - release.fraction) * (side * limit_ + within(then, limit_))};
  }
  if (std::abs(last.value) <= limit_) return plain;
  const Real side = std::copysign(Real(1), last.value);
  const Errors e = errors(step, end, side);
  const Dual fraction = held_after(side * last - limit_, e);
  const Dual held_integral =
      side * all - step.h * (1 - fraction) * positive_mean(error_at(fraction, e), e.last);
  return {side * (integral_gain_ > 0 ? larger(held_integral, at_limit(e)) : held_integral), true,
          side * limit_ + 0.5 * fraction * (first - side * limit_)};
}

// When T leaves the limit in a step that begins there. Until then T is constant, and c' keeps its tangent:
// the instant is exact to O(h^3), where other forces are smooth. First e falls until the unlimited T is
// below the limit; T then stays at the limit as long as I e would raise it faster than P e' lowers it.
SpeedMotor::Release SpeedMotor::release_of(Real memory, const Errors& e) const {
  const Real beyond = std::max(gain_ * e.first + integral_gain_ * memory - limit_, Real(0));
  Release release{first_root(beyond, gain_ * e.slope, gain_ * e.curvature), false};
  const Real s = release.fraction, growth = integral_gain_ * e.h;
  const Real rise = gain_ * (e.slope + 2 * e.curvature * s) + growth * e.at(s);
  if (s == 1 || !(rise > 0)) return release;
  const Real rise_rate = 2 * gain_ * e.curvature + growth * (e.slope + 2 * e.curvature * s);
  return {std::min(s + first_root(rise, rise_rate, growth * e.curvature), Real(1)), true};
}

// The change of z over a step that leaves the limit. A step that ends at the limit all the same has not left
// it.
Dual SpeedMotor::released(const Release& release, Real memory, const Errors& e) const {
  const Real s = release.fraction, then = e.at(s);
  if (integral_gain_ == 0) return -e.h * positive_mean(-e.first, -e.last);
  const Dual most = larger(at_limit(e) - memory, 0);
  if (release.follows && s == 1) return most;
  const Real before = release.follows ? (limit_ - gain_ * then) / integral_gain_ - memory : 0;
  return smaller(s < 1 && then > 0 ? before + 0.5 * e.h * (1 - s) * (then + e.last)
                                   : -e.h * positive_mean(-e.first, -e.last),
                 most);
}

// e at the instant where the limit is reached, after the fraction s of a step. Until then c' has its tangent
// at the start; from there on T is constant and c' a straight line:
//   c'(s) = c'_0 + s h c''_0 + (c'_1 - c'_0 - h c''_0) s / (2 - s).
Dual SpeedMotor::error_at(const Dual& fraction, const Errors& e) const {
  const Dual unlike = e.last - (e.first + e.slope + e.curvature);
  return e.first + fraction * (e.slope + fraction * e.curvature) + unlike * (fraction / (2 - fraction));
}

// The fraction after which the limit is reached, where the step begins within the limit and ends `last`
// beyond it: the change of P e + I z from there on, P (e_1 - e(s)) + I h (1 - s) (e(s) + e_1) / 2, is
// `last`.
Dual SpeedMotor::held_after(const Dual& last, const Errors& e) const {
  const auto remainder = [&](const Dual& s) {
    const Dual then = error_at(s, e);
    return gain_ * (e.last - then) + 0.5 * integral_gain_ * e.h * (1 - s) * (then + e.last) - last;
  };
  if (!(remainder(0).value > 0)) return 0;
  Real low = 0, high = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const Real middle = (low + high) / 2;
    (remainder(middle).value > 0 ? low : high) = middle;
  }
  const Dual rest = remainder(low);
  const Real slope = remainder(Dual{low, 1, 0, 0}).by_value - rest.by_value;
  if (!(slope < 0)) return low;
  return {low, -rest.by_value / slope, -rest.by_rate / slope, 0};
}

}  // namespace

std::unique_ptr<JointLaw> make_joint_law(const Motor& motor, Real end) {
  const std::string owner = fmt::format("motor '{}'", motor.name);
  switch (motor.kind) {
    case MotorKind::effort:
      return std::make_unique<EffortMotor>(motor, owner, end);
    case MotorKind::line:
      return std::make_unique<LineMotor>(motor, owner, end);
    case MotorKind::speed:
      return std::make_unique<SpeedMotor>(motor, owner, end);
    case MotorKind::position:
      return std::make_unique<PositionMotor>(motor, owner, end);
  }
  throw std::logic_error("a motor of no kind");
}

}  // namespace scree
