// Laws of springs and limits on joints.
#include "mbs/joint_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mbs/integral.hpp"
#include "model/derived/scalar_function.hpp"
#include "physics/normal_laws.hpp"
#include "physics/step_contact.hpp"

namespace scree {

namespace {

// A curve with its integral from its first point.
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

// d = c_lower - c, T = F(d, d'), or d = c - c_upper, T = -F(d, d'), with F a contact force without tension.
// Over a step that begins or ends beyond a limit it acts while c is beyond the limit
// (physics/step_contact.hpp).
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

std::unique_ptr<JointLaw> make_joint_law(const JointSpring& spring, Real start) {
  return std::make_unique<SpringLaw>(spring, start, fmt::format("joint spring '{}'", spring.name));
}

std::unique_ptr<JointLaw> make_joint_law(const JointLimit& limit, bool resolve_events) {
  return std::make_unique<LimitLaw>(limit, resolve_events);
}

}  // namespace scree
