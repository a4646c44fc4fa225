// A spring that slides where its force reaches a limit, with a dashpot beside it: Coulomb friction, and
// rolling and twisting resistance, which differ in what moves and what limits.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "physics/contact_motion.hpp"

namespace scree {

inline constexpr Real kNoSquare = 1e-290;  // squares below it have no exact root on a GPU

// a, no longer than limit.
SCREE_HD Vec3 shortened(Vec3 a, Real limit) {
  const Real square = fused_dot(a, a);
  if (square <= limit * limit) return a;
  if (square < kNoSquare) return {};
  return (limit * root_and_inverse(square).inverse) * a;
}

// Where the energy that a contact takes from a step has gone [J].
struct SpringLosses {
  Real sliding = 0;    // over the limit
  Real dashpot = 0;    // never negative
  Real unloading = 0;  // by a spring that weakens or stiffens under its force; never negative

  SCREE_HD Real sum() const { return sliding + dashpot + unloading; }
  SCREE_HD SpringLosses& operator+=(const SpringLosses& part) {
    sliding += part.sliding, dashpot += part.dashpot, unloading += part.unloading;
    return *this;
  }
};

// Parameters of one step of one contact. Forces [N] and ways [m], or moments [N m] and angles [rad].
struct SpringSlider {
  Real stiffness;   // k at the end of the step [N/m]
  Real stiffness0;  // at its start; 0 where the contact was open
  Real dashpot;     // [N s/m]
  Real limit;       // [N]
};

// The part of a dashpot that acts at an instant, and over an implicit step that begins there. As in
// spring_step() all of it acts beside a spring within its limit, and nothing beside one that slides, which is
// at the limit. What the end of an implicit step decides is a jump of the force, at which Newton's method
// stalls; the start decides the same as steps shrink. Within a small margin next to the limit a part acts:
// round-off decides nothing.
SCREE_HD Real dashpot_part(const SpringSlider& p, Vec3 spring) {
  constexpr Real kMargin = 1e-3;  // of the limit
  const Real room = p.limit - norm(spring), margin = kMargin * p.limit;
  return room >= margin ? 1 : room > 0 ? room / margin : 0;
}

// Of a spring and its dashpot at an instant; rate: of what the spring resists.
SCREE_HD Vec3 acting_at(const SpringSlider& p, Vec3 spring, Vec3 rate) {
  const Real dashpot = p.dashpot > 0 ? dashpot_part(p, spring) * p.dashpot : p.dashpot;
  return shortened(spring + dashpot * rate, p.limit);
}

struct SpringStep {
  Vec3 spring;  // the spring's force at the end of the step: what is remembered
  Vec3 acting;  // with the dashpot's
  SpringLosses losses;
};

// Elastic energy of a spring's force [J].
SCREE_HD Real spring_energy(Vec3 force, Real stiffness) {
  return stiffness > 0 ? dot(force, force) / (2 * stiffness) : 0;
}

// Of a stiffness that grows over a step like the radius of a circle of contact, with the root of the overlap:
// its mean over the overlap.
SCREE_HD Real mean_stiffness(Real k0, Real k1) {
  return Real(2) / 3 * (k1 * k1 + k1 * k0 + k0 * k0) * reciprocal(k1 + k0);
}

// What a change of the stiffness does to a spring over a step.
struct StiffnessStep {
  Real of_way;  // force per way [N/m]
  Real kept;    // of the old force [-]
};
SCREE_HD StiffnessStep stiffness_step(const SpringSlider& p) {
  if (p.stiffness > p.stiffness0) return {mean_stiffness(p.stiffness0, p.stiffness), 1};
  if (p.stiffness < p.stiffness0) return {p.stiffness, p.stiffness * reciprocal(p.stiffness0)};
  return {p.stiffness, 1};
}

// spring_energy() of the force before and after the step, less what the way does at the stiffness in between.
SCREE_HD Real unloading_loss(const SpringSlider& p, const StiffnessStep& k, Vec3 old, Vec3 spring) {
  if (p.stiffness < p.stiffness0) return dot(old, old) / 2 * (1 - k.kept) * reciprocal(p.stiffness0);
  if (!(p.stiffness > p.stiffness0)) return 0;
  const Real after = dot(spring, spring) * (p.stiffness - k.of_way) * reciprocal(p.stiffness * k.of_way);
  if (!(p.stiffness0 > 0)) return after / 2;
  return (after + dot(old, old) * (k.of_way - p.stiffness0) * reciprocal(p.stiffness0 * k.of_way)) / 2;
}

// The step of a spring whose force at the start, turned with the contact, was `old`, by `way`, as
// turned_across() and ContactMotion give them.
// - A stiffness k that depends on the overlap ("rescale rule": Walton; Thornton, Cummins, Cleary, Powder
//   Technol. 233, 2013, Eq. 18b): T' = k s' while the contact grows, (T/k)' = s' while it shrinks, s the way.
//   That never creates energy; the second is exact over a step, the first with the mean of k.
// - Return to the limit along the trial force. While it sticks the dashpot acts, too, and the sum stays
//   within the limit; while it slides the force is the limit: neither creates energy.
// Work of the spring's mean force over the way, plus that of the dashpot's, is the change of spring_energy()
// plus the losses, exactly. The sliding loss is the mean force over the way that slid: it could be negative
// only where within one step the limit falls below the old force and the way turns back by more than both.
SCREE_HD SpringStep spring_step(const SpringSlider& p, Vec3 old, Vec3 way, Real h) {
  SpringStep out;
  const StiffnessStep k = stiffness_step(p);
  const Vec3 start = k.kept * old, trial = fused(k.of_way, way, start);
  out.spring = shortened(trial, p.limit);
  out.acting = out.spring;
  if (fused_dot(trial, trial) > p.limit * p.limit)
    out.losses.sliding = dot(start + out.spring, trial - out.spring) * reciprocal(2 * k.of_way);
  else if (p.dashpot > 0) {
    out.acting = shortened(fused(p.dashpot * reciprocal(h), way, trial), p.limit);
    out.losses.dashpot = dot(out.acting - out.spring, way);
  }
  out.losses.unloading = unloading_loss(p, k, old, out.spring);
  return out;
}

}  // namespace scree
