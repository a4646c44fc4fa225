#include "mbs/joint_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/scalar_function.hpp"
#include "physics/step_contact.hpp"

namespace scree {

namespace {

// Of a function between two arguments, by Gauss's rule with three points: exact up to degree 5, the degree of
// the pieces of tables.
Real integral(const ScalarFunction& function, Real from, Real to) {
  static const Real kOuter = std::sqrt(Real(0.6));
  const Real middle = (from + to) / 2, half = (to - from) / 2;
  return half / 9 *
         (5 * function(middle - kOuter * half).value + 8 * function(middle).value +
          5 * function(middle + kOuter * half).value);
}

// A curve with its integral from its first point on.
class IntegratedCurve {
 public:
  IntegratedCurve(const Curve& curve, const std::string& owner) : function_(curve, owner), at_(curve.at) {
    for (std::size_t i = 0; i < at_.size(); ++i)
      integral_.push_back(i == 0 ? 0 : integral_.back() + scree::integral(function_, at_[i - 1], at_[i]));
  }
  TimeValue operator()(Real x) const { return function_(x); }
  Real integral(Real x) const {
    if (at_.empty()) return 0;
    const auto after = std::upper_bound(at_.begin() + 1, at_.end(), x);
    const auto i = static_cast<std::size_t>(after - at_.begin()) - 1;
    return integral_[i] + scree::integral(function_, at_[i], x);
  }

 private:
  ScalarFunction function_;
  std::vector<Real> at_, integral_;
};

class MotorLaw : public JointLaw {
 public:
  explicit MotorLaw(Real limit) : limit_(limit) {}
  bool drives() const final { return true; }

 protected:
  JointEffort limited(const JointEffort& wanted) const {
    if (std::abs(wanted.effort) <= limit_) return wanted;
    return {std::copysign(limit_, wanted.effort), 0, 0, limit_};
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

 private:
  ScalarFunction effort_;
};

// T = T_s (u(t) - c'/w_f)
class LineMotor final : public MotorLaw {
 public:
  LineMotor(const Motor& motor, const std::string& owner, Real end)
      : MotorLaw(motor.limit),
        stall_effort_(motor.stall_effort),
        slope_(-motor.stall_effort / motor.free_rate),
        command_(motor.command, owner, end) {}
  JointEffort effort(const CoordinateInstant& at, Real) const override {
    const Real driven = stall_effort_ * command_(at.time).value, turned = slope_ * at.rate;
    return limited({driven + turned, 0, slope_, std::max(std::abs(driven), std::abs(turned))});
  }

 private:
  Real stall_effort_, slope_;
  ScalarFunction command_;
};

// T = P e + I z, e = w(t) - c', z the integral of e: over a step that of w less the change of c. While the
// limit holds T back, z stays where e would drive it further.
class SpeedMotor final : public MotorLaw {
 public:
  SpeedMotor(const Motor& motor, const std::string& owner, Real end)
      : MotorLaw(motor.limit),
        gain_(motor.gain),
        integral_gain_(motor.integral_gain),
        rate_(motor.rate, owner, end) {}

  JointEffort effort(const CoordinateInstant& at, Real memory) const override {
    const Real size = std::max({gain_ * std::abs(rate_(at.time).value), gain_ * std::abs(at.rate),
                                integral_gain_ * std::abs(memory)});
    return limited({gain_ * error(at) + integral_gain_ * memory, -integral_gain_, -gain_, size});
  }
  JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const override {
    return effort(end, summed(step, end));
  }
  bool remembers() const override { return true; }
  Real memory_after(const LawStep& step, const CoordinateInstant& end) const override {
    const Real z = summed(step, end), e = error(end), wanted = gain_ * e + integral_gain_ * z;
    return std::abs(wanted) > limit_ && (wanted > 0) == (e > 0) ? step.memory : z;
  }

 private:
  Real error(const CoordinateInstant& at) const { return rate_(at.time).value - at.rate; }
  Real summed(const LawStep& step, const CoordinateInstant& end) const {
    return step.memory + integral(rate_, step.start.time, end.time) - (end.value - step.start.value);
  }

  Real gain_, integral_gain_;
  ScalarFunction rate_;
};

// T = -(k (c - c_0) + d c' + F(c) + G(c'))
class SpringLaw final : public JointLaw {
 public:
  SpringLaw(const JointSpring& spring, Real start, const std::string& owner)
      : spring_(spring),
        free_(spring.free.value_or(start)),
        elastic_(spring.elastic, owner),
        dissipative_(spring.dissipative, owner) {}

  JointEffort effort(const CoordinateInstant& at, Real) const override {
    const TimeValue elastic = elastic_(at.value), dissipative = dissipative_(at.rate);
    const Real stored = spring_.stiffness * (at.value - free_) + elastic.value;
    const Real lost = spring_.damping * at.rate + dissipative.value;
    return {-(stored + lost), -(spring_.stiffness + elastic.rate), -(spring_.damping + dissipative.rate),
            std::max(std::abs(stored), std::abs(lost))};
  }
  Real energy(Real c, Real) const override {
    const Real stretch = c - free_;
    return spring_.stiffness / 2 * stretch * stretch + elastic_.integral(c);
  }
  Real stiffness() const override { return spring_.stiffness; }

 private:
  JointSpring spring_;
  Real free_;
  IntegratedCurve elastic_;
  ScalarFunction dissipative_;
};

// d = c_lower - c, T = F(d, d'), or d = c - c_upper, T = -F(d, d'), F a contact's force without tension. Over
// a step that begins or ends beyond a limit it acts while it is beyond (physics/step_contact.hpp).
class LimitLaw final : public JointLaw {
 public:
  LimitLaw(const JointLimit& limit, bool resolve_events)
      : law_(limit.stiffness, limit.damping, limit.exponent, false),
        side_{{{-1, limit.lower}, {1, limit.upper}}},
        resolve_events_(resolve_events) {}

  JointEffort effort(const CoordinateInstant& at, Real) const override {
    JointEffort sum;
    for (const Side& side : side_) {
      const Real d = side.overlap(at);
      if (!(d > 0)) continue;
      const ContactForce force = contact_force(law_, d, side.sign * at.rate);
      add(sum, side, {force.force, force.stiffness, force.damping});
    }
    return sum;
  }
  JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const override {
    if (!resolve_events_ || step.h == 0) return effort(end, 0);
    JointEffort sum;
    for (const Side& side : side_) {
      const Real d0 = side.overlap(step.start), d1 = side.overlap(end);
      if (!(d0 > 0) && !(d1 > 0)) continue;
      const ContactStep contact{d0, side.sign * step.start.rate, d1, side.sign * end.rate, step.h};
      add(sum, side, step_contact_force(law_, contact));
    }
    return sum;
  }
  bool resolves_events() const override { return resolve_events_; }
  Real energy(Real c, Real) const override {
    Real sum = 0;
    for (const Side& side : side_)
      if (const Real d = side.overlap({0, c, 0}); d > 0) sum += law_.energy(d);
    return sum;
  }

 private:
  struct Side {
    Real sign, limit;
    Real overlap(const CoordinateInstant& at) const { return sign * (at.value - limit); }
  };
  static void add(JointEffort& sum, const Side& side, const StepContactForce& force) {
    sum.effort -= side.sign * force.force;
    sum.by_value -= force.stiffness;
    sum.by_rate -= force.damping;
    sum.size += std::abs(force.force);
  }

  PowerLaw law_;
  std::array<Side, 2> side_;
  bool resolve_events_;
};

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
  }
  throw std::logic_error("a motor of no kind");
}

std::unique_ptr<JointLaw> make_joint_law(const JointSpring& spring, Real start) {
  return std::make_unique<SpringLaw>(spring, start, fmt::format("joint spring '{}'", spring.name));
}

std::unique_ptr<JointLaw> make_joint_law(const JointLimit& limit, bool resolve_events) {
  return std::make_unique<LimitLaw>(limit, resolve_events);
}

}  // namespace scree
