#include <algorithm>
#include <cmath>

#include "mbs/joint_laws.hpp"
#include "physics/step_slider.hpp"

namespace scree {

namespace {

// A spring that slides holds the limit but for round-off; its effort follows the load, and so must the
// derivative.
constexpr Real kHeld = 1 - 1e-12;
// Where the limit falls and rises with the rate, one that slid over a step holds that of the mean rate.
constexpr Real kSlid = 0.99;

// Remembered: the effort z of the spring, which c stretches. T = -(z + d c'), no larger than
//   T_max = s(c') (T_0 + lever F),  s(c') = 1 + (ratio - 1) exp(-(c'/v_s)^2).
// Over a step the mean M of z + d c' by the return mapping of step_spring(), its limit that of the mean load
// and rate. The trapezoidal rule finds it where the end of the step holds T = -(2 M + T_start): work less
// what the spring stores is never below 0, at any step.
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
    const StepSpring over = spring_over(step, end);
    const Real start = effort(step.start, step.memory).effort, twice = 2 * over.mean.x;
    JointEffort out{-(twice + start), 0, 0, std::max(std::abs(start), std::abs(twice)), 0};
    if (over.grip == 0) {
      out.by_value = -2 * over.stiffness;
      return out;
    }
    const Real rate = mean_rate(step, end), sign = over.direction.x > 0 ? -1 : 1;
    out.by_value = sign * slope_at(rate) / step.h * (bound(step.start.load) + bound(end.load));
    out.by_load = sign * level_at(rate) * p_.lever;
    return out;
  }
  bool resolves_events() const override { return true; }
  bool remembers() const override { return true; }
  Real memory_after(const LawStep& step, const CoordinateInstant& end) const override {
    return step.h == 0 ? memory_under(step, end.load) : spring_over(step, end).spring.x;
  }
  bool is_loaded() const override { return p_.lever > 0; }
  Real energy(Real, Real memory) const override { return memory * memory / (2 * p_.stiffness); }
  Real stiffness() const override { return p_.stiffness; }

 private:
  static Real mean_rate(const LawStep& step, const CoordinateInstant& end) {
    return (end.value - step.start.value) / step.h;
  }
  Real bound(Real load) const { return p_.effort + p_.lever * load; }
  Real level_at(Real rate) const {
    const Real x = rate / p_.stribeck_rate;
    return 1 + (p_.static_ratio - 1) * std::exp(-x * x);
  }
  // A spring that slides holds the limit under every load.
  Real memory_under(const LawStep& at, Real load) const {
    const Real bound_then = bound(at.start.load), held = level_at(at.start.rate) * bound_then;
    if (load == at.start.load || held == 0 || std::abs(at.memory) < kSlid * held) return at.memory;
    return at.memory * (bound(load) / bound_then);
  }
  Real slope_at(Real rate) const {  // of the level
    return -2 * rate / (p_.stribeck_rate * p_.stribeck_rate) * (level_at(rate) - 1);
  }
  StepSpring spring_over(const LawStep& step, const CoordinateInstant& end) const {
    const Real level = level_at(mean_rate(step, end)), first = level * bound(step.start.load),
               last = level * bound(end.load);
    const SpringSlider slider{p_.stiffness, p_.stiffness, p_.damping, (first + last) / 2};
    return step_spring(slider, {step.memory, 0, 0}, {end.value - step.start.value, 0, 0}, step.h, last);
  }

  JointFriction p_;
};

}  // namespace

std::unique_ptr<JointLaw> make_joint_law(const JointFriction& friction) {
  return std::make_unique<FrictionLaw>(friction);
}

}  // namespace scree
