// A spring with slider and dashpot over an implicit step, whose mean force counts.
#pragma once

#include "base/hd.hpp"
#include "physics/spring_slider.hpp"

namespace scree {

// The mean force over a step, and its derivatives with respect to the way at the end of the step and to the
// limit: dM = stiffness (dw - (direction . dw) direction) + grip dL direction; direction is zero while it
// sticks. The first part is symmetric and positive; the second comes from a limit that changes with the
// normal force and makes a Newton matrix unsymmetric; that a force beyond the limit is shortened to it first
// is left out there.
struct StepSpring {
  Vec3 spring;     // the spring's force at the end of the step: what is remembered
  Vec3 mean;       // with the dashpot's, over the step
  Real stiffness;  // [N/m]
  Real elastic;    // of it the spring's, without the dashpot's [N/m]
  Vec3 direction;  // unit, while it slides
  Real grip;       // 1 while it slides, else 0
  SpringLosses losses;
};

// From the spring's force at the start (committed: iterations never change it), turned with the contact, by
// the same rules as spring_step(). p.limit: of the mean force L; end_limit: of the spring at the end L1, at
// most 2 L. The force at the start is first shortened to 2 L - L1, which is the limit there where limits are
// linear in time. Work of the mean force less the change of spring_energy() is then never negative, whatever
// the step and the way; while it sticks it is the dashpot's loss exactly, and the step is of second order.
SCREE_HD StepSpring step_spring(const SpringSlider& p, Vec3 old, Vec3 way, Real h, Real end_limit) {
  StepSpring out{};
  const StiffnessStep k = stiffness_step(p);
  const Vec3 kept = k.kept * old, start = shortened(kept, 2 * p.limit - end_limit),
             trial = start + k.of_way * way;
  const Real rate = p.dashpot * reciprocal(h);
  const Vec3 pull = Real(0.5) * (start + trial) + rate * way;
  out.spring = shortened(trial, end_limit);
  out.mean = shortened(pull, p.limit);
  out.elastic = k.of_way / 2, out.stiffness = out.elastic + rate;
  const Real square = dot(pull, pull);
  if (square > p.limit * p.limit && square >= kNoSquare) {
    const Real inverse = root_and_inverse(square).inverse;
    out.direction = inverse * pull, out.grip = 1;
    out.stiffness *= p.limit * inverse, out.elastic *= p.limit * inverse;
  }
  const Real stored = spring_energy(out.spring, k.of_way) - spring_energy(kept, k.of_way);
  out.losses.dashpot = out.grip > 0 ? 0 : rate * dot(way, way);
  out.losses.sliding = dot(out.mean, way) - stored - out.losses.dashpot;
  out.losses.unloading = unloading_loss(p, k, old, out.spring);
  return out;
}

}  // namespace scree
