// Friction of a contact over an implicit step; its normal force is in step_contact.hpp.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"
#include "physics/step_slider.hpp"

namespace scree {

// Input of the friction of a contact over an implicit step.
struct FrictionStep {
  ContactStep step;
  ContactMotion motion;   // with the mean spins
  Real lever_arm_ratio0;  // `ContactMotion::lever_arm_ratio` at the start
  // Tangential velocity of i relative to j at both ends [m/s]; for laws with a dashpot.
  Vec3 slip_rate0, slip_rate1;
  PairSize size;
  Real start_force, end_force;  // of the normal law at both ends [N]
  Real step_force;              // normal force that the step is solved with, see `StepContact` [N]
  // Lagged limit of the mean force over the step [N]; for laws with rolling resistance the lagged load that
  // all limits are proportional to, see `StepFriction::limit`. Negative: the limits follow the normal force.
  Real lagged_limit;
};

// Friction force T over an implicit step (dem/README.md): -lever_arm_ratio T acts on i, and normal x T times
// the arms is the torque on both.
struct StepFriction {
  // Force at the start, force that the step is solved with, force at the end [N]; tangential at normal0,
  // normal1, normal1.
  Vec3 start, step, end;
  // Limit of the mean force over the step [N]. For laws with rolling resistance: the load of that limit,
  // which determines the limits of rolling and twisting too [N].
  Real limit;
  // Derivatives of `step`: `stiffness` with respect to the slip perpendicular to `direction` [N/m], and
  // `normal_force_slope` along `direction` with respect to step_force. `direction` is the unit vector of
  // sliding, or zero while the contact sticks. `overlap_slope` is the derivative with respect to the overlap
  // at the end beside that by the normal force, because the fraction of the step in contact changes where the
  // contact opens or closes [N/m].
  Real stiffness, normal_force_slope;
  Vec3 direction, overlap_slope;
  Vec3 spring;  // for the history; zero where the contact has ended
  SpringLosses losses;
  Real stored0, stored1;  // energy of the spring at both ends [J]
};

// Fraction of the step in contact, from linear interpolation of the overlap.
SCREE_HD Real closed_fraction(const ContactStep& c) {
  if (c.change.kind != Changeover::Kind::none) return c.change.share;
  if (c.overlap1 > 0) return c.overlap0 > 0 ? 1 : c.overlap1 / (c.overlap1 - c.overlap0);
  return c.overlap0 > 0 ? c.overlap0 / (c.overlap0 - c.overlap1) : 0;
}

// Derivative of `closed_fraction()` with respect to the overlap at the end [1/m].
SCREE_HD Real closed_fraction_slope(const ContactStep& c) {
  if ((c.overlap0 > 0) == (c.overlap1 > 0)) return 0;
  const Real change = c.overlap1 - c.overlap0;
  return std::abs(c.overlap0) / (change * change);
}

// Spring and slider of a closed contact at one instant; d: overlap there [m].
template <class Law>
SCREE_HD SpringSlider slider_at(const Law& law, const FrictionStep& c, Real normal_force, Real d,
                                Real lever_arm_ratio) {
  ContactMotion at = c.motion;
  at.lever_arm_ratio = lever_arm_ratio;
  return law.tangential.slider(c.size, at,
                               normal_contact(law.normal.of_pair(c.size), c.size, normal_force, d, d));
}

// Derivative of fraction times mean force with respect to the fraction: a sticking contact acts longer, with
// a larger displacement of its spring; for a sliding one the limit is that of the same normal impulse.
// displacement: over the fraction.
SCREE_HD Vec3 share_derivative(const StepSpring& over, Vec3 displacement) {
  const Vec3 elastic_part =
      over.elastic * (displacement - dot(over.direction, displacement) * over.direction);
  return over.limit_slope > 0 ? elastic_part : over.mean + elastic_part;
}

// Friction over an implicit step. The mean force over the step, and with it work and impulse, is that of
// `step_spring()` over the fraction of the step in contact, with the limit of the mean normal force. The
// trapezoidal rule reproduces it with a force at the end of
//   step = 2 mean - start, `start` rotated with the contact.
// For a sticking contact this is the spring's force at the end. A sliding one does not oscillate from step to
// step, because `start` is the spring's force and not `step` of the previous step. The active fraction of a
// dashpot (`dashpot_part()`) is constant over the step, so that the derivatives are those of a spring and a
// constant dashpot. spring: from the history, tangential at normal0 [N].
template <class Law>
SCREE_HD StepFriction step_friction(const Law& law, const FrictionStep& c, Vec3 spring) {
  StepFriction out{};
  const bool is_lagged = c.lagged_limit >= 0;
  const Real share = is_lagged ? 1 : closed_fraction(c.step);
  const Real mean_force = Real(0.5) * (c.start_force + c.step_force);
  const bool starts = c.step.acts_at_start(), ends = c.step.acts_at_end();
  SpringSlider first{};
  if (starts) {
    first = slider_at(law, c, c.start_force, c.step.overlap0, c.lever_arm_ratio0);
    out.start = acting_at(first, spring, c.slip_rate0);
  }
  if (!(share > 0)) return out;
  NormalContact contact = normal_contact(law.normal.of_pair(c.size), c.size, mean_force / share,
                                         c.step.overlap1, c.step.overlap0);
  if constexpr (Law::Rolling::acts)
    if (is_lagged) contact.friction_load = c.lagged_limit;
  SpringSlider slider = law.tangential.slider(c.size, c.motion, contact), end{};
  if constexpr (!Law::Rolling::acts)
    if (is_lagged) slider.limit = c.lagged_limit;
  if (ends) end = slider_at(law, c, c.end_force, c.step.overlap1, c.motion.lever_arm_ratio);
  const Real twice = 2 * slider.limit, end_limit = is_lagged           ? slider.limit
                                                   : end.limit < twice ? end.limit
                                                                       : twice;
  if (slider.dashpot > 0 && starts) slider.dashpot *= dashpot_part(first, spring);
  const StepSpring over = step_spring(slider, rotated_tangential(c.motion, spring), share * c.motion.slip,
                                      share * c.motion.h, end_limit);
  out.limit = share * (Law::Rolling::acts ? contact.friction_load : slider.limit);
  out.step = (2 * share) * over.mean - rotated_tangential(c.motion, out.start);
  out.stiffness = 2 * share * share * over.stiffness;
  if (!is_lagged)
    out.overlap_slope = (2 * closed_fraction_slope(c.step)) * share_derivative(over, share * c.motion.slip);
  if (over.limit_slope > 0)
    out.direction = over.direction,
    out.normal_force_slope = is_lagged ? 0 : law.tangential.friction * reciprocal(c.motion.lever_arm_ratio);
  out.losses = over.losses;
  out.stored0 = spring_energy(spring, slider.stiffness0);
  const Real stored = spring_energy(over.spring, slider.stiffness);
  if (ends)
    out.spring = over.spring, out.stored1 = stored, out.end = acting_at(end, over.spring, c.slip_rate1);
  else
    out.losses.sliding += stored;  // with lagged limits, and in contacts that change over
  return out;
}

}  // namespace scree
