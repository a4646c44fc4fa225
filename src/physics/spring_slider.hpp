// A spring that slides where its force reaches a limit, with a dashpot beside it: Coulomb friction, and
// rolling and twisting resistance, which differ in what moves and what limits.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "physics/contact_motion.hpp"

namespace scree {

// a, no longer than limit.
SCREE_HD Vec3 shortened(Vec3 a, Real limit) {
  constexpr Real kNothing = 1e-290;  // squares below it have no exact root on a GPU
  const Real square = dot(a, a);
  if (square <= limit * limit) return a;
  if (square < kNothing) return {};
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

struct SpringStep {
  Vec3 spring;  // the spring's force at the end of the step: what is remembered
  Vec3 acting;  // with the dashpot's
  SpringLosses losses;
};

// Elastic energy of a spring's force [J].
SCREE_HD Real spring_energy(Vec3 force, Real stiffness) {
  return stiffness > 0 ? dot(force, force) / (2 * stiffness) : 0;
}

// The step of a spring whose force at the start, turned with the contact, was `old`, by `way`, as
// turned_across() and ContactMotion give them.
// - A stiffness that depends on the overlap ("rescale rule": Walton; Thornton, Cummins, Cleary, Powder
//   Technol. 233, 2013, Eq. 18b): the force stays while the contact grows and falls with the stiffness while
//   it shrinks, which never creates energy.
// - Return to the limit along the trial force. While it sticks the dashpot acts, too, and the sum stays
//   within the limit; while it slides the force is the limit: neither creates energy.
// Work of the springs' mean force over the way, plus that of the dashpot's, is the change of spring_energy()
// plus the losses, exactly. The sliding loss is the mean force over the way that slid: it could be negative
// only where within one step the limit falls below the old force and the way turns back by more than both.
SCREE_HD SpringStep spring_step(const SpringSlider& p, Vec3 old, Vec3 way, Real h) {
  SpringStep out;
  const Vec3 start = p.stiffness < p.stiffness0 ? (p.stiffness / p.stiffness0) * old : old;
  out.losses.unloading = spring_energy(old, p.stiffness0) - spring_energy(start, p.stiffness);
  const Vec3 trial = start + p.stiffness * way;
  out.spring = shortened(trial, p.limit);
  out.acting = out.spring;
  const bool slides = dot(trial, trial) > p.limit * p.limit;
  if (slides)
    out.losses.sliding = dot(start + out.spring, trial - out.spring) / (2 * p.stiffness);
  else if (p.dashpot > 0)
    out.acting = shortened(trial + (p.dashpot / h) * way, p.limit);
  out.losses.dashpot = dot(out.acting - out.spring, way);
  return out;
}

}  // namespace scree
