// Normal contact law: Kelvin-Voigt with exponent. Jung, Jun, Sohn (2013), Eqs. 18-24.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/vec3.hpp"

namespace scree {

// F = K d^n + C d_dot along the normal while d > 0; F > 0 pushes the two apart.
struct KelvinVoigt {
  Real normal_stiffness = 0;  // K [N/m^n]
  Real normal_damping = 0;    // C [N s/m]
  Real exponent = 1;          // n [-]
  bool tension = false;       // true: Eq. 18 as printed, F may pull before separation; false: F is cut at zero
};

// Overlap and normal of a pair at one instant. r = r_i - r_j.
struct Overlap {
  Real overlap;   // d [m], positive when touching
  Real distance;  // |r| [m]
  Vec3 normal;    // unit vector from j to i
};

// Paper's Eqs. 19-21, 23, 24.
SCREE_HD Overlap sphere_overlap(Vec3 r, Real radius_sum) {
  const Real distance = std::sqrt(dot(r, r));
  const Real inverse = 1 / distance;
  return {radius_sum - distance, distance, inverse * r};
}

// The force of one contact and its derivatives with respect to overlap and overlap rate.
struct ContactForce {
  Real force;      // F [N]
  Real stiffness;  // dF/dd [N/m]
  Real damping;    // dF/d(d_dot) [N s/m]
  Real loss;       // power taken out of the mechanical energy, (F - K d^n) d_dot [W]
};

// K d^n and its slope. A policy per exponent keeps pow() out of the linear law's kernels.
struct LinearElastic {
  SCREE_HD static Real force(const KelvinVoigt& law, Real d) { return law.normal_stiffness * d; }
  SCREE_HD static Real stiffness(const KelvinVoigt& law, Real) { return law.normal_stiffness; }
  SCREE_HD static Real energy(const KelvinVoigt& law, Real d) { return Real(0.5) * law.normal_stiffness * d * d; }
};

struct PowerElastic {
  SCREE_HD static Real force(const KelvinVoigt& law, Real d) { return law.normal_stiffness * std::pow(d, law.exponent); }
  SCREE_HD static Real stiffness(const KelvinVoigt& law, Real d) {
    return law.normal_stiffness * law.exponent * std::pow(d, law.exponent - 1);
  }
  SCREE_HD static Real energy(const KelvinVoigt& law, Real d) {
    return law.normal_stiffness / (law.exponent + 1) * std::pow(d, law.exponent + 1);
  }
};

// How the jump of the damping force at first touch is treated. In an implicit step it can make neither the open
// nor the closed contact consistent with the overlap at the step's end; what is consistent is a force between the
// two at zero overlap. A ramp finds it: damping of an approaching contact grows over this overlap.
struct DampingRamp {
  Real overlap = 0;  // [m]; 0: none, the law as it stands
};

// Force of a closed contact: overlap d > 0 [m], overlap rate d_dot [m/s], positive when approaching.
template <class Elastic>
SCREE_HD ContactForce contact_force(const KelvinVoigt& law, Real d, Real d_dot, DampingRamp ramp = {}) {
  const bool ramped = d < ramp.overlap && d_dot > 0;
  const Real damping = ramped ? law.normal_damping * (d / ramp.overlap) : law.normal_damping;
  const Real elastic = Elastic::force(law, d);
  const Real force = elastic + damping * d_dot;
  if (force < 0 && !law.tension) return {0, 0, 0, -elastic * d_dot};
  Real stiffness = Elastic::stiffness(law, d);
  if (ramped) stiffness += law.normal_damping * d_dot / ramp.overlap;
  return {force, stiffness, damping, damping * d_dot * d_dot};
}

}  // namespace scree
