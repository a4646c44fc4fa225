// Normal force of a contact over an implicit step, within which it may open or close.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "physics/contact_law.hpp"

namespace scree {

// Transition of a contact to another one at equal overlap within a step: a sphere whose centre is inside a
// closed mesh touches only the nearest face.
struct Changeover {
  enum class Kind : unsigned char { none, begins, ends };

  Kind kind = Kind::none;  // whether this contact begins or ends there
  Real overlap = 0;        // of both contacts at the transition [m]
  Real share = 1;          // fraction of the step during which this contact acts
};

// A contact at the start (0) and the end (1) of a time step. Negative overlaps are gaps.
struct ContactStep {
  Real overlap0, rate0;  // [m], [m/s]
  Real overlap1, rate1;
  Real h;  // [s]
  Changeover change{};

  SCREE_HD bool acts_at_start() const { return overlap0 > 0 && change.kind != Changeover::Kind::begins; }
  SCREE_HD bool acts_at_end() const { return overlap1 > 0 && change.kind != Changeover::Kind::ends; }
  // Overlaps between which the contact acts in a step in which it changes over.
  SCREE_HD Real changing_from() const {
    return change.kind == Changeover::Kind::begins ? change.overlap : overlap0;
  }
  SCREE_HD Real changing_to() const {
    return change.kind == Changeover::Kind::begins ? overlap1 : change.overlap;
  }
};

// Force that a step is solved with, and its derivatives with respect to the overlap and its rate at the end.
struct StepContactForce {
  Real force;      // F [N]
  Real stiffness;  // dF/d(overlap1) [N/m]
  Real damping;    // dF/d(rate1) [N s/m]
};

// Force of the law at the start of the step [N].
template <class NormalLaw>
SCREE_HD Real start_force(const NormalLaw& law, const ContactStep& c) {
  return c.acts_at_start() ? contact_force(law, c.overlap0, c.rate0).force : 0;
}

// Force F that the trapezoidal rule must use at the end of the step, in place of the law's force there, so
// that impulse and work are right although the contact opens or closes within the step:
//   impulse h (F0 + F) / 2 = integral of the force over the part of the step that is in contact.
// With that part from linear interpolation of the overlap, the elastic work (F0 + F) / 2 (d1 - d0) is exactly
// the change of the elastic energy: no step size creates energy at impacts. This is the discrete gradient of
// LaBudde and Greenspan (1974) and of Simo, Tarnow and Wong (1992). F is continuous at d1 = 0, where the
// law's force may jump by C d_dot, so that Newton's method cannot cycle between open and closed; with an
// attraction A it falls from 0 to the jump -A within the step that closes the contact. Negative derivatives
// are set to 0.

// Closing contact, d0 <= 0 < d1: in contact over the fraction d1 / (d1 - d0), at the rate (d1 - d0) / h.
template <class NormalLaw>
SCREE_HD StepContactForce touching_force(const NormalLaw& law, const ContactStep& c) {
  const Real change = c.overlap1 - c.overlap0;
  const Real elastic = 2 * law.energy(c.overlap1) / change;
  const Real slope = (2 * law.elastic(c.overlap1) - elastic) / change + 2 * law.damping(c.overlap1) / c.h;
  return {elastic + 2 * law.mean_damping(0, c.overlap1) * c.overlap1 / c.h, slope > 0 ? slope : 0, 0};
}

// Opening contact with tension, d1 <= 0 < d0: in contact over the fraction d0 / (d0 - d1).
template <class NormalLaw>
SCREE_HD StepContactForce releasing_force(const NormalLaw& law, const ContactStep& c,
                                          const ContactForce& start) {
  const Real change = c.overlap0 - c.overlap1;
  const Real elastic = 2 * law.energy(c.overlap0) / change;
  const Real damper = 2 * law.mean_damping(0, c.overlap0) * c.overlap0 / c.h;
  return {elastic - damper - start.force, elastic > 0 ? elastic / change : 0, 0};
}

// Opening contact without tension: d0 > 0, and the law's force F1 at the end is negative (end_force,
// extrapolated with the slope at the start). The force decreases linearly to zero over the fraction F0 / (F0
// - F1).
SCREE_HD StepContactForce fading_force(const ContactForce& start, Real end_force) {
  const Real share = end_force < 0 ? start.force / (start.force - end_force) : 1;
  return {share * start.force - start.force, share * share * start.stiffness, share * share * start.damping};
}

// Mean of the elastic force between two overlaps [N].
template <class NormalLaw>
SCREE_HD Real mean_elastic(const NormalLaw& law, Real from, Real to) {
  // Over a span that round-off would spoil, the midpoint.
  if (!(std::abs(to - from) > 1e-4 * (from + to))) return law.elastic((from + to) / 2);
  return (law.energy(to) - law.energy(from)) / (to - from);
}

// Contact that changes over: it acts over change.share, at the rate (d1 - d0) / h. The elastic work of both
// contacts is exactly the change of the elastic energy, because the transition is at equal overlap. Where the
// two act in opposite directions the derivative has no positive definite part.
template <class NormalLaw>
SCREE_HD StepContactForce changing_force(const NormalLaw& law, const ContactStep& c) {
  const Real from = c.changing_from(), to = c.changing_to();
  const Real damping = from < to ? law.mean_damping(from, to) : law.mean_damping(to, from);
  Real mean = mean_elastic(law, from, to) + damping * (c.overlap1 - c.overlap0) / c.h;
  if (mean < 0 && !law.tension) mean = 0;
  const Real start = start_force(law, c);
  return {2 * c.change.share * mean - start, 0, 0};
}

// Force of a contact over a step within which it may open or close.
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
