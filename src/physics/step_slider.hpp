// Mean force of a spring-slider-dashpot over an implicit step.
#pragma once

#include "base/hd.hpp"
#include "physics/spring_slider.hpp"

namespace scree {

// Mean force over a step, and its derivatives with respect to the displacement w at the end of the step and
// to the limit L: dM = stiffness (dw - (direction . dw) direction) + limit_slope dL direction; direction is
// zero while the spring sticks. The first part is symmetric and positive; the second comes from a limit that
// changes with the normal force and makes the Newton matrix unsymmetric. The derivative of scaling the old
// force to the limit is neglected.
struct StepSpring {
  Vec3 spring;       // force of the spring at the end of the step, for the history
  Vec3 mean;         // mean force of spring and dashpot over the step
  Real stiffness;    // [N/m]
  Real elastic;      // the spring's part of the stiffness [N/m]
  Vec3 direction;    // unit vector of sliding; zero while sticking
  Real limit_slope;  // 1 while sliding, else 0
  SpringLosses losses;
};

// Step of a spring from its force at the start, rotated with the contact, by the rules of `spring_step()`;
// the force at the start is that of the last accepted step, which iterations do not change. p.limit: of the
// mean force, L; end_limit: of the spring at the end, L1, at most 2 L. The force at the start is first scaled
// to 2 L - L1, the limit there for limits that are linear in time. The work of the mean force less the change
// of `spring_energy()` is then never negative for any step and displacement; while the spring sticks it
// equals the dashpot's loss exactly, and the step is second order.
SCREE_HD StepSpring step_spring(const SpringSlider& p, Vec3 old, Vec3 displacement, Real h, Real end_limit) {
  StepSpring out{};
  const StiffnessStep k = stiffness_step(p);
  const Vec3 retained = k.remaining * old, start = shortened(retained, 2 * p.limit - end_limit),
             trial = start + k.step_stiffness * displacement;
  const Real rate = p.dashpot * reciprocal(h);
  const Vec3 trial_mean = Real(0.5) * (start + trial) + rate * displacement;
  out.spring = shortened(trial, end_limit);
  out.mean = shortened(trial_mean, p.limit);
  out.elastic = k.step_stiffness / 2, out.stiffness = out.elastic + rate;
  const Real square = dot(trial_mean, trial_mean);
  if (square > p.limit * p.limit && square >= kNoSquare) {
    const Real inverse = root_and_inverse(square).inverse;
    out.direction = inverse * trial_mean, out.limit_slope = 1;
    out.stiffness *= p.limit * inverse, out.elastic *= p.limit * inverse;
  }
  const Real stored = spring_energy(out.spring, k.step_stiffness) - spring_energy(retained, k.step_stiffness);
  out.losses.dashpot = out.limit_slope > 0 ? 0 : rate * dot(displacement, displacement);
  out.losses.sliding = dot(out.mean, displacement) - stored - out.losses.dashpot;
  out.losses.unloading = unloading_loss(p, k, old, out.spring);
  return out;
}

}  // namespace scree
