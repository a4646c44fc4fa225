#include <algorithm>
#include <cmath>

#include "mbs/joint_laws.hpp"
#include "mbs/limited_line.hpp"

namespace scree {

namespace {

// A spring that slides holds the limit but for round-off; its effort follows the load, and so must the
// derivative.
constexpr Real kHeld = 1 - 1e-12;
// The share from which a spring slides whose limit was found with reactions that converged to round-off.
constexpr Real kSlid = 1 - 1e-9;

// Remembered: the effort z of the spring, which c stretches. T = -(z + d c'), no larger than
//   T_max = s(c') (T_0 + lever F),  s(c') = 1 + (ratio - 1) exp(-(c'/v_s)^2).
// Over a step z + d c' runs along a straight line that the limits at its ends hold back, with the mean M. The
// trapezoidal rule finds M where the end of the step holds T = -(2 M + T_start): work less what the spring
// stores is never below 0, at any step.
class FrictionLaw final : public JointLaw {
 public:
  explicit FrictionLaw(const JointFriction& friction) : p_(friction) {}

  JointEffort effort(const CoordinateInstant& at, Real memory) const override {
    const Real pull = memory + p_.damping * at.rate, level = level_at(at.rate);
    const Real limit = level * bound(at.load);
    if (std::abs(pull) < kHeld * limit) return {-pull, 0, -p_.damping, std::abs(pull), 0};
    const Real sign = pull > 0 ? -1 : 1;
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
  bool remembers() const override { return true; }
  Real memory_after(const LawStep& step, const CoordinateInstant& end) const override {
    return step.h == 0 ? memory_under(step, end.load) : over(step, end).spring.value;
  }
  bool is_loaded() const override { return p_.lever > 0; }
  Real energy(Real, Real memory) const override { return memory * memory / (2 * p_.stiffness); }
  Real stiffness() const override { return p_.stiffness; }

 private:
  // The mean of z + d c' over the step, held back, and z at its end.
  struct Over {
    Dual mean, spring;
  };
  // Quantities at both ends of a step, in units of z that grow with the rate at its start where the rate
  // changes its sign.
  struct Ends {
    Real spring, rate, bound;    // z, c' and T_0 + lever F at the start
    Real first;                  // the limit there
    Dual way, last_rate, trial;  // c_1 - c_0; c' of the straight line with this way; z without a limit
    Dual last_bound, last;       // T_0 + lever F and the limit at the end
  };

  Real bound(Real load) const { return p_.effort + p_.lever * load; }
  Real level_at(Real rate) const {
    const Real x = rate / p_.stribeck_rate;
    return 1 + (p_.static_ratio - 1) * std::exp(-x * x);
  }
  Real slope_at(Real rate) const {  // of the level
    return -2 * rate / (p_.stribeck_rate * p_.stribeck_rate) * (level_at(rate) - 1);
  }
  // A spring that slides holds the limit under every load.
  Real memory_under(const LawStep& at, Real load) const {
    const Real bound_then = bound(at.start.load), held = level_at(at.start.rate) * bound_then;
    if (load == at.start.load || held == 0 || std::abs(at.memory) < kSlid * held) return at.memory;
    return at.memory * (bound(load) / bound_then);
  }

  Ends ends_of(const LawStep& step, const CoordinateInstant& end, Real side) const;
  Over over(const LawStep& step, const CoordinateInstant& end) const;
  Over turned(const Ends& e, Real h) const;
  Dual kept(const Ends& e, const Over& over, Real h) const;

  JointFriction p_;
};

FrictionLaw::Ends FrictionLaw::ends_of(const LawStep& step, const CoordinateInstant& end, Real side) const {
  Ends e;
  e.rate = side * step.start.rate, e.bound = bound(step.start.load);
  e.first = level_at(step.start.rate) * e.bound;
  e.spring = std::clamp(side * step.memory, -e.first, e.first);
  e.way = Dual{side * (end.value - step.start.value), side, 0, 0};
  e.last_rate = (2 / step.h) * e.way - e.rate;
  e.trial = e.spring + p_.stiffness * e.way;
  e.last_bound = Dual{bound(end.load), 0, 0, p_.lever};
  e.last = Dual{level_at(end.rate), 0, slope_at(end.rate), 0} * e.last_bound;
  return e;
}

FrictionLaw::Over FrictionLaw::over(const LawStep& step, const CoordinateInstant& end) const {
  const Real side = step.start.rate < 0 ? -1 : 1;
  const Ends e = ends_of(step, end, side);
  Over over;
  if (e.rate > 0 && e.last_rate.value < 0) {
    over = turned(e, step.h);
  } else {
    const Dual first = e.spring + p_.damping * e.rate, last = e.trial + p_.damping * e.last_rate;
    over = {limited_mean(first, last, e.first, e.last), within(e.trial, e.last)};
  }
  over.mean = kept(e, over, step.h);
  return {side * over.mean, side * over.spring};
}

// A step in which the joint turns back, after the share s: up to there z grows, as far as the limit of a
// joint at rest, and from there it falls. No motion back undoes the slide before the turn; else a joint that
// comes to rest would stick later than it does. Each part has what the limits change of its own line. The
// trapezoidal mean of z itself stays that of the ends, so that a step that sticks is conservative. A way back
// that is long enough to pull the spring the other way does not resolve this motion: it counts as one line.
FrictionLaw::Over FrictionLaw::turned(const Ends& e, Real h) const {
  const Dual share = e.rate / (e.rate - e.last_rate), there = 0.5 * e.rate * h * share, back = e.way - there;
  const Dual limit = level_at(0) * (e.bound + share * (e.last_bound - e.bound));
  const Dual whole = e.spring + p_.stiffness * there, top = within(whole, limit),
             trial = top + p_.stiffness * back;
  const Dual unturned = within(e.trial, e.last);
  const Dual spring = larger(within(trial, e.last), smaller(unturned, 0));
  const Dual before =
      limited_mean(e.spring + p_.damping * e.rate, whole, e.first, limit) - 0.5 * (e.spring + top);
  const Dual after =
      limited_mean(top, trial + p_.damping * e.last_rate, limit, e.last) - 0.5 * (top + spring);
  return {0.5 * (e.spring + spring) + share * before + (1 - share) * after, spring};
}

// The mean with which the step takes no less than nothing. With the dashpot at the mean rate that holds for
// every step; with the rates at both ends, which have the dashpot right where it is held back, the mean goes
// only as far from there as it may.
Dual FrictionLaw::kept(const Ends& e, const Over& over, Real h) const {
  const Dual dashpot = (p_.damping / h) * e.way;
  const Dual safe = limited_mean(e.spring + dashpot, e.trial + dashpot, e.first, e.last);
  const Dual stored = (over.spring * over.spring - e.spring * e.spring) / (2 * p_.stiffness);
  const Dual lost = safe * e.way - stored, change = (over.mean - safe) * e.way;
  if (lost.value + change.value >= 0 || change.value >= 0) return over.mean;
  return safe + larger(lost, 0) / -change * (over.mean - safe);
}

}  // namespace

std::unique_ptr<JointLaw> make_joint_law(const JointFriction& friction) {
  return std::make_unique<FrictionLaw>(friction);
}

}  // namespace scree
