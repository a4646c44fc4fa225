// The friction of a contact over an implicit step: what its law along the normal has in step_contact.hpp.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "physics/contact_law.hpp"
#include "physics/step_contact.hpp"
#include "physics/step_slider.hpp"

namespace scree {

// Over an implicit step, as friction sees it.
struct RubbingStep {
  ContactStep step;
  ContactMotion motion;  // with the mean spins
  Real leverage0;        // ContactMotion::leverage at the start
  Vec3 slip_rate0,
      slip_rate1;  // of i over j, across the normals at both ends [m/s]; where a law has a dashpot
  PairSize size;
  Real start_force, end_force;  // along the normal, the law's at both ends [N]
  Real step_force;              // and what the step is solved with, as in StepContact [N]
  Real frozen_limit;  // of the mean force over the step [N]; negative: it follows from the normal forces
};

// The vector T of section "Contacts that rub": -leverage T acts on i, and normal x T times the arms turns
// both.
struct StepRub {
  Vec3 start, step,
      end;     // acting at both ends, and what the step's end must hold [N]; across normal0, normal1
  Real limit;  // of the mean force over the step [N]
  // Derivatives of `step`: stiffness across `direction` by the slip [N/m], grip along it by step_force;
  // direction: unit, while it slides, else zero; growth by the overlap at the end beside grip's, because a
  // contact that opens or closes rubs for longer, or less long [N/m].
  Real stiffness, grip;
  Vec3 direction, growth;
  Vec3 spring;  // what is remembered; zero where the contact has ended
  SpringLosses losses;
  Real stored0, stored1;  // energy of the spring at both ends [J]
};

// Share of the step that the two touch, from the straight line between the overlaps.
SCREE_HD Real closed_share(const ContactStep& c) {
  if (c.change.kind != Changeover::Kind::none) return c.change.share;
  if (c.overlap1 > 0) return c.overlap0 > 0 ? 1 : c.overlap1 / (c.overlap1 - c.overlap0);
  return c.overlap0 > 0 ? c.overlap0 / (c.overlap0 - c.overlap1) : 0;
}

// By the overlap at the end [1/m].
SCREE_HD Real closed_share_slope(const ContactStep& c) {
  if ((c.overlap0 > 0) == (c.overlap1 > 0)) return 0;
  const Real travel = c.overlap1 - c.overlap0;
  return std::abs(c.overlap0) / (travel * travel);
}

// Spring and slider at one instant, where the contact is closed; d: its overlap there [m].
template <class Law>
SCREE_HD SpringSlider slider_at(const Law& law, const RubbingStep& c, Real normal_force, Real d,
                                Real leverage) {
  ContactMotion at = c.motion;
  at.leverage = leverage;
  return law.tangential.slider(c.size, at,
                               normal_contact(law.normal.of_pair(c.size), c.size, normal_force, d, d));
}

// share times the mean force, by the share: while the contact sticks it acts for longer, and its spring is
// drawn farther; in a slide the limit is that of the same impulse of the normal force. way: over the share.
SCREE_HD Vec3 by_share(const StepSpring& over, Vec3 way) {
  const Vec3 drawn = over.elastic * (way - dot(over.direction, way) * over.direction);
  return over.grip > 0 ? drawn : over.mean + drawn;
}

// The mean of the force over the step is right, and with it work and impulse: step_spring() over the share of
// the step that the two touch, with the limit of the mean normal force. The trapezoidal rule finds it where
// the end of the step holds twice the mean less what acted at the start, turned with the contact:
//   step = 2 mean - start.
// While it sticks that is the spring's force at the end; in a slide nothing swings from step to step, because
// `start` is the spring's, not `step` of the step before. Of a dashpot the same part acts over the whole step
// (dashpot_part()), wherever the step ends, so that derivatives are those of a spring and a constant dashpot.
// spring: as remembered, across normal0.
template <class Law>
SCREE_HD StepRub step_rub(const Law& law, const RubbingStep& c, Vec3 spring) {
  StepRub out{};
  const bool frozen = c.frozen_limit >= 0;
  const Real share = frozen ? 1 : closed_share(c.step);
  const Real mean_force = Real(0.5) * (c.start_force + c.step_force);
  const bool starts = c.step.acts_at_start(), ends = c.step.acts_at_end();
  SpringSlider first{};
  if (starts) {
    first = slider_at(law, c, c.start_force, c.step.overlap0, c.leverage0);
    out.start = acting_at(first, spring, c.slip_rate0);
  }
  if (!(share > 0)) return out;
  const NormalContact contact = normal_contact(law.normal.of_pair(c.size), c.size, mean_force / share,
                                               c.step.overlap1, c.step.overlap0);
  SpringSlider slider = law.tangential.slider(c.size, c.motion, contact), end{};
  if (frozen) slider.limit = c.frozen_limit;
  if (ends) end = slider_at(law, c, c.end_force, c.step.overlap1, c.motion.leverage);
  const Real twice = 2 * slider.limit, end_limit = frozen              ? slider.limit
                                                   : end.limit < twice ? end.limit
                                                                       : twice;
  if (slider.dashpot > 0 && starts) slider.dashpot *= dashpot_part(first, spring);
  const StepSpring over = step_spring(slider, turned_across(c.motion, spring), share * c.motion.slip,
                                      share * c.motion.h, end_limit);
  out.limit = share * slider.limit;
  out.step = (2 * share) * over.mean - turned_across(c.motion, out.start);
  out.stiffness = 2 * share * share * over.stiffness;
  if (!frozen) out.growth = (2 * closed_share_slope(c.step)) * by_share(over, share * c.motion.slip);
  if (over.grip > 0)
    out.direction = over.direction,
    out.grip = frozen ? 0 : law.tangential.friction * reciprocal(c.motion.leverage);
  out.losses = over.losses;
  out.stored0 = spring_energy(spring, slider.stiffness0);
  const Real left = spring_energy(over.spring, slider.stiffness);
  if (ends)
    out.spring = over.spring, out.stored1 = left, out.end = acting_at(end, over.spring, c.slip_rate1);
  else
    out.losses.sliding += left;  // of limits that were frozen, and of contacts that change over
  return out;
}

}  // namespace scree
