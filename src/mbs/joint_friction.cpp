#include <algorithm>
#include <cmath>

#include "mbs/joint_laws.hpp"
#include "mbs/limited_line.hpp"

namespace scree {

namespace {

// A sliding spring is at the limit but for round-off; its effort follows the load, and so must the
// derivative.
constexpr Real kHeld = 1 - 1e-12;
// Ratio to the limit from which a spring counts as sliding where the limit was found with reactions
// converged to round-off.
constexpr Real kSlid = 1 - 1e-9;

// Memory: the effort z of the spring, which c deflects. T = -(z + d c'), no larger than
//   T_max = s(c') (T_0 + lever F),  s(c') = 1 + (ratio - 1) exp(-(c'/v_s)^2).
// Over a step z + d c' follows a straight line that is clipped by the limits at its ends; M is the mean of
// the clipped line. The trapezoidal rule gives M where the end of the step has T = -(2 M + T_start): work
// less the change of the spring's energy is never negative, at any step.
class FrictionLaw final : public JointLaw {
 public:
  explicit FrictionLaw(const JointFriction& friction) : p_(friction) {}

  JointEffort effort(const CoordinateInstant& at, Real memory) const override {
    const Real unlimited = memory + p_.damping * at.rate, level = level_at(at.rate);
    const Real limit = level * bound(at.load);
    if (std::abs(unlimited) < kHeld * limit) return {-unlimited, 0, -p_.damping, std::abs(unlimited), 0};
    const Real sign = unlimited > 0 ? -1 : 1;
    return {sign * limit, 0, sign * slope_at(at.rate) * bound(at.load), limit, sign * level * p_.lever};
  }
  JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const override {
    if (step.h == 0) return effort(end, step.memory);
    const Real start = effort(step.start, step.memory).effort;
    const Dual twice = 2 * over(step, end).mean;
    return {-(twice.value + start), -twice.by_value, -twice.by_rate,
            std::max(std::abs(start), std::abs(twice.value)), -twice.by_load};
  }
  bool resolves_events() const override { return true; }
  bool has_memory() const override { return true; }
  Real memory_after(const LawStep& step, const CoordinateInstant& end) const override {
    return step.h == 0 ? memory_under(step, end.load) : over(step, end).spring.value;
  }
  bool is_loaded() const override { return p_.lever > 0; }
  Real energy(Real, Real memory) const override { return memory * memory / (2 * p_.stiffness); }
  Real stiffness() const override { return p_.stiffness; }

 private:
  // The clipped mean of z + d c' over the step, and z at its end.
  struct Over {
    Dual mean, spring;
  };
  // Quantities at both ends of a step, in units of z; their sign is that of the rate at the start where the
  // rate changes its sign.
  struct Ends {
    Real spring, rate, bound;  // z, c' and T_0 + lever F at the start
    Real first;                // the limit at the start
    Dual displacement;         // c_1 - c_0
    Dual last_rate;            // c' at the end of the straight line with this displacement
    Dual trial;                // z at the end without a limit
    Dual last_bound, last;     // T_0 + lever F and the limit at the end
  };

  Real bound(Real load) const { return p_.effort + p_.lever * load; }
  Real level_at(Real rate) const {
    const Real x = rate / p_.stribeck_rate;
    return 1 + (p_.static_ratio - 1) * std::exp(-x * x);
  }
  Real slope_at(Real rate) const {  // slope of level_at()
    return -2 * rate / (p_.stribeck_rate * p_.stribeck_rate) * (level_at(rate) - 1);
  }
  // A sliding spring is at the limit under every load.
  Real memory_under(const LawStep& at, Real load) const {
    const Real bound_then = bound(at.start.load), held = level_at(at.start.rate) * bound_then;
    if (load == at.start.load || held == 0 || std::abs(at.memory) < kSlid * held) return at.memory;
    return at.memory * (bound(load) / bound_then);
  }

  Ends ends_of(const LawStep& step, const CoordinateInstant& end, Real side) const;
  Over over(const LawStep& step, const CoordinateInstant& end) const;
  Over reversing_step(const Ends& e, Real h) const;
  Dual dissipative_mean(const Ends& e, const Over& over, Real h) const;

  JointFriction p_;
};

FrictionLaw::Ends FrictionLaw::ends_of(const LawStep& step, const CoordinateInstant& end, Real side) const {
  Ends e;
  e.rate = side * step.start.rate, e.bound = bound(step.start.load);
  e.first = level_at(step.start.rate) * e.bound;
  e.spring = std::clamp(side * step.memory, -e.first, e.first);
  e.displacement = Dual{side * (end.value - step.start.value), side, 0, 0};
  e.last_rate = (2 / step.h) * e.displacement - e.rate;
  e.trial = e.spring + p_.stiffness * e.displacement;
  e.last_bound = Dual{bound(end.load), 0, 0, p_.lever};
  e.last = Dual{level_at(end.rate), 0, slope_at(end.rate), 0} * e.last_bound;
  return e;
}

FrictionLaw::Over FrictionLaw::over(const LawStep& step, const CoordinateInstant& end) const {
  const Real side = step.start.rate < 0 ? -1 : 1;
  const Ends e = ends_of(step, end, side);
  Over over;
  if (e.rate > 0 && e.last_rate.value < 0) {
    over = reversing_step(e, step.h);
  } else {
    const Dual first = e.spring + p_.damping * e.rate, last = e.trial + p_.damping * e.last_rate;
    over = {limited_mean(first, last, e.first, e.last), within(e.trial, e.last)};
  }
  over.mean = dissipative_mean(e, over, step.h);
  return {side * over.mean, side * over.spring};
}

// A step in which the joint reverses, after the fraction s. Until then z grows, up to the limit of a joint
// at rest; from there it falls. The reversed motion does not undo the sliding before it; otherwise a joint
// that comes to rest would stick too late. Each part has the clipping correction of its own line. The
// trapezoidal mean of z itself stays that of the ends, so that a sticking step is conservative. A reversed
// displacement long enough to reverse the spring's effort is not resolved in this way and counts as one
// line.
FrictionLaw::Over FrictionLaw::reversing_step(const Ends& e, Real h) const {
  const Dual fraction = e.rate / (e.rate - e.last_rate), forward = 0.5 * e.rate * h * fraction,
             backward = e.displacement - forward;
  const Dual limit = level_at(0) * (e.bound + fraction * (e.last_bound - e.bound));
  const Dual whole = e.spring + p_.stiffness * forward, top = within(whole, limit),
             trial = top + p_.stiffness * backward;
  const Dual unreversed = within(e.trial, e.last);
  const Dual spring = larger(within(trial, e.last), smaller(unreversed, 0));
  const Dual before =
      limited_mean(e.spring + p_.damping * e.rate, whole, e.first, limit) - 0.5 * (e.spring + top);
  const Dual after =
      limited_mean(top, trial + p_.damping * e.last_rate, limit, e.last) - 0.5 * (top + spring);
  return {0.5 * (e.spring + spring) + fraction * before + (1 - fraction) * after, spring};
}

// The mean with which the step dissipates no less than zero. With the dashpot at the mean rate this holds
// for every step. The rates at both ends are exact for the dashpot where it is clipped, but the mean may
// follow them only as far as the dissipation stays positive.
Dual FrictionLaw::dissipative_mean(const Ends& e, const Over& over, Real h) const {
  const Dual dashpot = (p_.damping / h) * e.displacement;
  const Dual safe = limited_mean(e.spring + dashpot, e.trial + dashpot, e.first, e.last);
  const Dual stored = (over.spring * over.spring - e.spring * e.spring) / (2 * p_.stiffness);
  const Dual lost = safe * e.displacement - stored, change = (over.mean - safe) * e.displacement;
  if (lost.value + change.value >= 0 || change.value >= 0) return over.mean;
  return safe + larger(lost, 0) / -change * (over.mean - safe);
}

}  // namespace

std::unique_ptr<JointLaw> make_joint_law(const JointFriction& friction) {
  return std::make_unique<FrictionLaw>(friction);
}

}  // namespace scree
