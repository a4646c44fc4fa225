// The law of a contact along its normal over an implicit step, in which it may open or close.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "physics/contact_law.hpp"

namespace scree {

// A contact that does not touch or part within a step, but changes over to another one where both have the
// same overlap: a sphere whose centre is inside a closed mesh touches the nearest face alone.
struct Changeover {
  enum class Kind : unsigned char { none, begins, ends };

  Kind kind = Kind::none;  // what this contact does there
  Real overlap = 0;        // of both there [m]
  Real share = 1;          // of the step that this contact acts
};

// A contact over one time step: at its start (0) and its end (1). Overlaps may be negative: gaps.
struct ContactStep {
  Real overlap0, rate0;  // [m], [m/s]
  Real overlap1, rate1;
  Real h;  // [s]
  Changeover change{};

  SCREE_HD bool acts_at_start() const { return overlap0 > 0 && change.kind != Changeover::Kind::begins; }
  SCREE_HD bool acts_at_end() const { return overlap1 > 0 && change.kind != Changeover::Kind::ends; }
  // While it acts, in a step in which it changes over.
  SCREE_HD Real changing_from() const {
    return change.kind == Changeover::Kind::begins ? change.overlap : overlap0;
  }
  SCREE_HD Real changing_to() const {
    return change.kind == Changeover::Kind::begins ? overlap1 : change.overlap;
  }
};

// The force of a contact for a step, and its derivatives with respect to the overlap and its rate at the end.
struct StepContactForce {
  Real force;      // F [N]
  Real stiffness;  // dF/d(overlap1) [N/m]
  Real damping;    // dF/d(rate1) [N s/m]
};

// Of the law where the step begins [N].
template <class NormalLaw>
SCREE_HD Real start_force(const NormalLaw& law, const ContactStep& c) {
  return c.acts_at_start() ? contact_force(law, c.overlap0, c.rate0).force : 0;
}

// What the trapezoidal rule must find at the end of the step, in place of the force there, for the step's
// impulse and work to be right although the contact opens or closes within the step:
//   impulse h (F0 + F) / 2 = force summed over the part of the step that is spent in contact.
// With that part from the straight line between the overlaps, the elastic work (F0 + F) / 2 (d1 - d0) is
// exactly the change of the elastic energy: no step size creates energy at impacts. This is the discrete
// gradient of LaBudde and Greenspan (1974) and of Simo, Tarnow and Wong (1992). F is continuous at d1 = 0,
// where the force itself may jump by C d_dot: a Newton loop cannot cycle between open and closed. stiffness
// and damping are cut at 0.

// d0 <= 0 < d1: in contact over the share d1 / (d1 - d0), at the rate (d1 - d0) / h.
template <class NormalLaw>
SCREE_HD StepContactForce touching_force(const NormalLaw& law, const ContactStep& c) {
  const Real travel = c.overlap1 - c.overlap0;
  const Real elastic = 2 * law.energy(c.overlap1) / travel;
  const Real slope = (2 * law.elastic(c.overlap1) - elastic) / travel + 2 * law.damping(c.overlap1) / c.h;
  return {elastic + 2 * law.mean_damping(0, c.overlap1) * c.overlap1 / c.h, slope, 0};
}

// d1 <= 0 < d0 with tension: in contact over the share d0 / (d0 - d1).
template <class NormalLaw>
SCREE_HD StepContactForce releasing_force(const NormalLaw& law, const ContactStep& c,
                                          const ContactForce& start) {
  const Real travel = c.overlap0 - c.overlap1;
  const Real elastic = 2 * law.energy(c.overlap0) / travel;
  const Real damper = 2 * law.mean_damping(0, c.overlap0) * c.overlap0 / c.h;
  return {elastic - damper - start.force, elastic / travel, 0};
}

// d0 > 0 without tension, the law's force F1 at the end negative (end_force, beyond release along the slope
// at the start): the force falls to zero in a straight line over the share F0 / (F0 - F1).
SCREE_HD StepContactForce fading_force(const ContactForce& start, Real end_force) {
  const Real share = end_force < 0 ? start.force / (start.force - end_force) : 1;
  return {share * start.force - start.force, share * share * start.stiffness, share * share * start.damping};
}

// The mean of the elastic force over the overlaps between these two.
template <class NormalLaw>
SCREE_HD Real mean_elastic(const NormalLaw& law, Real from, Real to) {
  // Across a span that round-off would spoil, the middle.
  if (!(std::abs(to - from) > 1e-4 * (from + to))) return law.elastic((from + to) / 2);
  return (law.energy(to) - law.energy(from)) / (to - from);
}

// In contact over change.share, at the rate (d1 - d0) / h: the elastic work of both contacts is exactly the
// change of the elastic energy, as they change over at the same overlap. Where both push in opposite
// directions the derivative has no part that is positive definite.
template <class NormalLaw>
SCREE_HD StepContactForce changing_force(const NormalLaw& law, const ContactStep& c) {
  const Real from = c.changing_from(), to = c.changing_to();
  const Real damping = from < to ? law.mean_damping(from, to) : law.mean_damping(to, from);
  Real mean = mean_elastic(law, from, to) + damping * (c.overlap1 - c.overlap0) / c.h;
  if (mean < 0 && !law.tension) mean = 0;
  const Real start = start_force(law, c);
  return {2 * c.change.share * mean - start, 0, 0};
}

// The contact over a step that may open or close within it.
template <class NormalLaw>
SCREE_HD StepContactForce step_contact_force(const NormalLaw& law, const ContactStep& c) {
  if (c.change.kind != Changeover::Kind::none) return changing_force(law, c);
  if (c.overlap0 <= 0) return c.overlap1 > 0 ? touching_force(law, c) : StepContactForce{0, 0, 0};
  const ContactForce start = contact_force(law, c.overlap0, c.rate0);
  if (c.overlap1 > 0) {
    const ContactForce end = contact_force(law, c.overlap1, c.rate1);
    if (end.force > 0 || law.tension) return {end.force, end.stiffness, end.damping};
  }
  if (law.tension) return releasing_force(law, c, start);
  const Real stiffness = c.overlap1 > 0 ? law.slope(c.overlap1) : law.slope(c.overlap0);
  const Real elastic = c.overlap1 > 0 ? law.elastic(c.overlap1) : stiffness * c.overlap1;
  const Real damping = law.damping(c.overlap1 > 0 ? c.overlap1 : 0);
  const Real end_force = elastic + damping * c.rate1;
  if (end_force > 0) return {end_force, stiffness, damping};
  return fading_force(start, end_force);
}

}  // namespace scree
