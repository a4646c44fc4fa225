// Moment of rolling and twisting resistance of a contact over an implicit step, by the rules of
// step_friction.hpp.
#pragma once

#include "base/hd.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/step_friction.hpp"

namespace scree {

// Moment M over an implicit step: -M acts on i and M on j, without an arm.
struct StepRolling {
  // Moment at the start, moment that the step is solved with, moment at the end [N m]; rolling parts are
  // tangential at normal0, normal1, normal1, and twisting parts along these.
  Vec3 start, step, end;
  // Derivatives of `step` with respect to the rotation of i relative to j [N m]: `rolling` across the normal
  // and perpendicular to `direction`, `twisting` along the normal. direction: unit vector of rolling at the
  // limit, else zero. The load slopes are the derivatives with respect to the normal force that the step is
  // solved with, along `direction` and along the normal, because the limits follow that force [m].
  Real rolling, twisting;
  Vec3 direction;
  Real rolling_load_slope, twisting_load_slope;
  Vec3 spring;  // for the history [N m]; zero where the contact has ended
  SpringLosses rolling_losses, twisting_losses;
  Real stored0, stored1;  // energy of the springs at both ends [J]
};

// Spin of i relative to j at both ends of a step [rad/s].
struct RelativeSpins {
  Vec3 start, end;
};

// One of both moments: its spring, slider and dashpot at the start of the step, for the mean moment, and at
// the end; and its kinematics.
struct MomentPath {
  SpringSlider first, mean, last;
  Vec3 spring, rotated_spring;  // of the history, and rotated to the end [N m]
  Vec3 rotation;                // over the whole step [rad]
  Vec3 rate0, rate1;            // at both ends [rad/s]
};
struct MomentStep {
  Vec3 start, end;  // [N m]
  StepSpring over;  // the fraction of the step in contact
  SpringLosses losses;
  Real stored0, stored1;  // [J]
};

// The part of a step in which a contact acts.
struct StepPart {
  Real share, h;   // fraction of the step, and the whole step [s]
  bool is_lagged;  // whether the limits are lagged
  bool starts, ends;

  SCREE_HD static StepPart of(const FrictionStep& c) {
    const bool is_lagged = c.lagged_limit >= 0;
    return {is_lagged ? 1 : closed_fraction(c.step), c.motion.h, is_lagged, c.step.acts_at_start(),
            c.step.acts_at_end()};
  }
};

SCREE_HD MomentStep moment_step(MomentPath p, const StepPart& part) {
  MomentStep out{};
  if (part.starts) out.start = acting_at(p.first, p.spring, p.rate0);
  if (!(part.share > 0)) return out;
  const Real twice = 2 * p.mean.limit, end_limit = part.is_lagged         ? p.mean.limit
                                                   : p.last.limit < twice ? p.last.limit
                                                                          : twice;
  if (p.mean.dashpot > 0 && part.starts) p.mean.dashpot *= dashpot_part(p.first, p.spring);
  out.over = step_spring(p.mean, p.rotated_spring, part.share * p.rotation, part.share * part.h, end_limit);
  out.losses = out.over.losses;
  out.stored0 = spring_energy(p.spring, p.mean.stiffness0);
  const Real stored = spring_energy(out.over.spring, p.mean.stiffness);
  if (part.ends)
    out.stored1 = stored, out.end = acting_at(p.last, out.over.spring, p.rate1);
  else
    out.over.spring = {}, out.losses.sliding += stored;
  return out;
}

// A contact at the start of a step, of the mean moment over it, and at the end, as rolling laws read it.
template <class Law>
struct RollingContacts {
  ContactMotion motion0;
  const ContactMotion& motion;
  const PairSize& size;
  NormalContact first, mean, last;
  SpringSlider slip[3];

  SCREE_HD RollingContacts(const Law& law, const FrictionStep& c, const StepPart& part)
      : motion0(c.motion), motion(c.motion), size(c.size) {
    const auto normal = law.normal.of_pair(size);
    const Real d0 = c.step.overlap0, d1 = c.step.overlap1;
    const Real mean_force = part.share > 0 ? Real(0.5) * (c.start_force + c.step_force) / part.share : 0;
    first = normal_contact(normal, size, c.start_force, d0, d0);
    mean = normal_contact(normal, size, mean_force, d1, d0);
    last = normal_contact(normal, size, c.end_force, d1, d1);
    if (part.is_lagged) mean.friction_load = c.lagged_limit;
    motion0.lever_arm_ratio = c.lever_arm_ratio0;
    slip[0] = law.tangential.slider(size, motion0, first);
    slip[1] = law.tangential.slider(size, motion, mean), slip[2] = law.tangential.slider(size, motion, last);
  }
  SCREE_HD RollingContact of_mean() const { return {size, motion, mean, slip[1]}; }
  // Sliders of a rolling or a twisting law; the kinematics are left zero.
  template <class MomentLaw>
  SCREE_HD MomentPath path(const MomentLaw& law) const {
    MomentPath out{};
    out.first = law.slider({size, motion0, first, slip[0]}), out.mean = law.slider(of_mean());
    out.last = law.slider({size, motion, last, slip[2]});
    return out;
  }
};

// Adds one of both moments to the step, but for the subtraction of the moment at the start.
SCREE_HD void add_moment(const MomentStep& one, const StepPart& part, StepRolling& out) {
  out.start += one.start, out.step += (2 * part.share) * one.over.mean, out.end += one.end;
  out.spring += one.over.spring, out.stored0 += one.stored0, out.stored1 += one.stored1;
}

// Adds the viscous moment. The Newton matrix has one stiffness across `direction`: where the spring slides
// beside a viscous moment, it gets a larger one in all directions.
SCREE_HD void add_viscous_moment(Real viscosity, const MomentPath& path, const StepPart& part,
                                 StepRolling& out) {
  if (!(viscosity > 0)) return;
  const Real rate = viscosity * part.share * reciprocal(part.h);
  out.direction = {}, out.rolling_load_slope = 0, out.rolling += 2 * rate;
  if (part.starts) out.start += viscosity * path.rate0;
  if (part.ends) out.end += viscosity * path.rate1;
  out.step += (2 * rate) * path.rotation;
  out.rolling_losses.dashpot += rate * dot(path.rotation, path.rotation);
}

// Moment over an implicit step. Its mean is that of `step_spring()` for rolling and for twisting, each with
// the limit of the mean normal force, plus the viscous moment of the mean rolling rate. moment: of the
// springs, from the history [N m].
template <class Law>
SCREE_HD StepRolling step_rolling(const Law& law, const FrictionStep& c, const RelativeSpins& spins,
                                  Vec3 moment) {
  StepRolling out{};
  const StepPart part = StepPart::of(c);
  const RollingContacts<Law> contacts(law, c, part);
  const Vec3 n0 = c.motion.normal0, n1 = c.motion.normal1, rotated = rotated_with(c.motion, moment);
  const Vec3 along0 = dot(moment, n0) * n0, along1 = dot(rotated, n1) * n1;
  const Vec3 twist0 = dot(spins.start, n0) * n0, twist1 = dot(spins.end, n1) * n1;
  if constexpr (Law::Rolling::kRolls) {
    MomentPath path = contacts.path(law.rolling.rolling);
    path.spring = moment - along0, path.rotated_spring = rotated - along1;
    path.rotation = c.motion.rolling, path.rate0 = spins.start - twist0, path.rate1 = spins.end - twist1;
    const MomentStep step = moment_step(path, part);
    add_moment(step, part, out), out.rolling_losses = step.losses;
    out.rolling = 2 * part.share * part.share * step.over.stiffness, out.direction = step.over.direction;
    if (step.over.limit_slope > 0 && !part.is_lagged)
      out.rolling_load_slope = law.rolling.rolling.limit_per_load(contacts.of_mean());
    add_viscous_moment(law.rolling.rolling.viscosity(), path, part, out);
  }
  if constexpr (Law::Rolling::kTwists) {
    MomentPath path = contacts.path(law.rolling.twisting);
    path.spring = along0, path.rotated_spring = along1;
    path.rotation = c.motion.twisting * n1, path.rate0 = twist0, path.rate1 = twist1;
    const MomentStep step = moment_step(path, part);
    add_moment(step, part, out), out.twisting_losses = step.losses;
    if (!(step.over.limit_slope > 0))
      out.twisting = 2 * part.share * part.share * step.over.stiffness;
    else if (!part.is_lagged)
      out.twisting_load_slope =
          law.rolling.twisting.limit_per_load(contacts.of_mean()) * dot(step.over.direction, n1);
  }
  if (part.share > 0) out.step -= rotated_with(c.motion, out.start);
  return out;
}

}  // namespace scree
