// Spring-slider-dashpot: a spring that slides where its force reaches a limit, with a parallel dashpot. It
// serves Coulomb friction and rolling and twisting resistance, which differ in displacement and limit.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "physics/contact_motion.hpp"

namespace scree {

inline constexpr Real kNoSquare = 1e-290;  // smaller squares have no exact root on a GPU

// Scales a to the length `limit` if it is longer.
SCREE_HD Vec3 shortened(Vec3 a, Real limit) {
  const Real square = fused_dot(a, a);
  if (square <= limit * limit) return a;
  if (square < kNoSquare) return {};
  return (limit * root_and_inverse(square).inverse) * a;
}

// Losses of a contact over a step, by mechanism [J].
struct SpringLosses {
  Real sliding = 0;    // sliding at the limit
  Real dashpot = 0;    // dashpot; never negative
  Real unloading = 0;  // change of stiffness under load

  SCREE_HD Real sum() const { return sliding + dashpot + unloading; }
  SCREE_HD SpringLosses& operator+=(const SpringLosses& part) {
    sliding += part.sliding, dashpot += part.dashpot, unloading += part.unloading;
    return *this;
  }
};

// Parameters of one contact for one step. Forces [N] and displacements [m], or moments [N m] and angles
// [rad].
struct SpringSlider {
  Real stiffness;   // k at the end of the step [N/m]
  Real stiffness0;  // k at the start of the step; 0 where the contact was open
  Real dashpot;     // [N s/m]
  Real limit;       // [N]
};

// Fraction of the dashpot that acts at an instant, and over an implicit step that begins there. As in
// `spring_step()`, the dashpot acts in full while the spring is within its limit, and not at all while it
// slides at the limit. The decision is taken at the start of an implicit step: at the end it would make the
// force jump, and Newton's method stall; both agree as steps shrink. Within a small margin below the limit
// the fraction is linear, so that round-off decides nothing.
SCREE_HD Real dashpot_part(const SpringSlider& p, Vec3 spring) {
  constexpr Real kMargin = 1e-3;  // of the limit
  const Real headroom = p.limit - norm(spring), margin = kMargin * p.limit;
  return headroom >= margin ? 1 : headroom > 0 ? headroom / margin : 0;
}

// Force of spring and dashpot at an instant; rate: of the displacement.
SCREE_HD Vec3 acting_at(const SpringSlider& p, Vec3 spring, Vec3 rate) {
  const Real dashpot = p.dashpot > 0 ? dashpot_part(p, spring) * p.dashpot : p.dashpot;
  return shortened(spring + dashpot * rate, p.limit);
}

struct SpringStep {
  Vec3 spring;  // force of the spring at the end of the step, for the history
  Vec3 acting;  // force of spring and dashpot
  SpringLosses losses;
};

// Elastic energy of a spring's force [J].
SCREE_HD Real spring_energy(Vec3 force, Real stiffness) {
  return stiffness > 0 ? dot(force, force) / (2 * stiffness) : 0;
}

// Effect of a change of the stiffness on a spring over a step.
struct StiffnessStep {
  Real step_stiffness;  // force per displacement [N/m]
  Real remaining;       // fraction of the old force that remains [-]
  Real inverse0;        // 1 / k0 where k shrinks
};
// One reciprocal for both directions: in a warp some contacts grow and others shrink. Without branches, as
// the compiler vectorizes no others; where the stiffness does not change the reciprocal is not used.
SCREE_HD StiffnessStep stiffness_step(const SpringSlider& p) {
  const Real k0 = p.stiffness0, k1 = p.stiffness;
  const bool grows = k1 > k0, shrinks = k1 < k0;
  const Real inverse = reciprocal(grows ? k1 + k0 : k0);
  // Where it grows, the mean over the overlap of a stiffness in proportion to the contact radius, that is to
  // the root of the overlap.
  return {grows ? Real(2) / 3 * (k1 * k1 + k1 * k0 + k0 * k0) * inverse : k1, shrinks ? k1 * inverse : 1,
          inverse};
}

// Energy that a change of the stiffness dissipates [J]: `spring_energy()` before and after the step, less the
// work of the displacement at the effective stiffness.
SCREE_HD Real unloading_loss(const SpringSlider& p, const StiffnessStep& k, Vec3 old, Vec3 spring) {
  const bool grows = p.stiffness > p.stiffness0, shrinks = p.stiffness < p.stiffness0;
  if (!grows && !shrinks) return 0;
  const Real before = dot(old, old);
  if (shrinks) return before / 2 * (1 - k.remaining) * k.inverse0;
  const Real after =
      dot(spring, spring) * (p.stiffness - k.step_stiffness) * reciprocal(p.stiffness * k.step_stiffness);
  if (!(p.stiffness0 > 0)) return after / 2;
  return (after + before * (k.step_stiffness - p.stiffness0) * reciprocal(p.stiffness0 * k.step_stiffness)) /
         2;
}

// Step of a spring by `displacement`. old: force at the start, rotated with the contact by
// `rotated_tangential()`.
// - Stiffness k that depends on the overlap ("rescale rule": Walton; Thornton, Cummins, Cleary, Powder
//   Technol. 233, 2013, Eq. 18b): T' = k s' while the contact grows, (T/k)' = s' while it shrinks, s the
//   displacement. This never creates energy; the second case is exact over a step, the first uses the mean of
//   k.
// - Return to the limit along the trial force. While the spring sticks, the dashpot acts, and the sum stays
//   within the limit; while it slides, the force equals the limit: neither creates energy.
// The work of the spring's mean force, that of the forces at both ends, and of the dashpot over the
// displacement is exactly the change of `spring_energy()` plus the losses. The sliding loss is the force
// times the sliding displacement: it could be negative only if within one step the limit dropped below the
// old force and the displacement reversed by more than both. So could the loss by unloading if the
// displacement reversed by more than the elongation.
SCREE_HD SpringStep spring_step(const SpringSlider& p, Vec3 old, Vec3 displacement, Real h) {
  SpringStep out;
  const StiffnessStep k = stiffness_step(p);
  const Vec3 start = k.remaining * old, trial = fused(k.step_stiffness, displacement, start);
  out.spring = shortened(trial, p.limit);
  out.acting = out.spring;
  if (fused_dot(trial, trial) > p.limit * p.limit)
    out.losses.sliding = dot(start + out.spring, trial - out.spring) * reciprocal(2 * k.step_stiffness);
  else if (p.dashpot > 0) {
    out.acting = shortened(fused(p.dashpot * reciprocal(h), displacement, trial), p.limit);
    out.losses.dashpot = dot(out.acting - out.spring, displacement);
  }
  // The step begins with the force `old`: where the stiffness shrinks, its excess over `start` does work.
  out.losses.unloading = unloading_loss(p, k, old, out.spring);
  if (k.remaining < 1) out.losses.unloading += (1 - k.remaining) / 2 * fused_dot(old, displacement);
  return out;
}

}  // namespace scree
