// Normal contact law: Kelvin-Voigt with exponent. Jung, Jun, Sohn (2013), Eqs. 18-24.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"

namespace scree {

// F = K d^n + C d_dot along the normal while d > 0; F > 0 pushes the two apart. T: double, or single where a
// GPU computes forces in mixed precision.
template <class T>
struct KelvinVoigtOf {
  T normal_stiffness = 0;  // K [N/m^n]
  T normal_damping = 0;    // C [N s/m]
  T exponent = 1;          // n [-]
  bool tension = false;    // true: Eq. 18 as printed, F may pull before separation; false: F is cut at zero
};
using KelvinVoigt = KelvinVoigtOf<Real>;

SCREE_HD KelvinVoigtOf<float> in_single(const KelvinVoigt& law) {
  return {static_cast<float>(law.normal_stiffness), static_cast<float>(law.normal_damping),
          static_cast<float>(law.exponent), law.tension};
}

// Overlap and normal of a pair at one instant. r = r_i - r_j.
struct Overlap {
  Real overlap;   // d [m], positive when touching
  Real distance;  // |r| [m]
  Vec3 normal;    // unit vector from j to i
};

// Paper's Eqs. 19-21, 23, 24.
SCREE_HD Overlap sphere_overlap(Vec3 r, Real radius_sum) {
  const RootAndInverse<Real> distance = root_and_inverse(dot(r, r));
  return {radius_sum - distance.root, distance.root, distance.inverse * r};
}

// The same without the normal, for loops where its components are not needed one by one.
template <class T>
struct GapOf {
  T overlap;           // d [m]
  T inverse_distance;  // 1 / |r| [1/m]
};
using Gap = GapOf<Real>;

// squared_distance: |r|^2 [m^2].
template <class T>
SCREE_HD GapOf<T> sphere_gap(T squared_distance, T radius_sum) {
  const auto distance = root_and_inverse(squared_distance);
  return {radius_sum - distance.root, distance.inverse};
}

// Overlap rate d_dot [m/s] of a pair: minus the normal part of the velocity of i relative to j.
template <class Vector, class T>
SCREE_HD T approach_rate(Vector r, T inverse_distance, Vector relative_velocity) {
  return -inverse_distance * dot(r, relative_velocity);
}

// The force of one contact and its derivatives with respect to overlap and overlap rate.
template <class T>
struct ContactForceOf {
  T force;      // F [N]
  T stiffness;  // dF/dd [N/m]
  T damping;    // dF/d(d_dot) [N s/m]
  T loss;       // power taken out of the mechanical energy, (F - K d^n) d_dot [W]
};
using ContactForce = ContactForceOf<Real>;

// K d^n and its slope. A policy per exponent keeps pow() out of the linear law's kernels.
struct LinearElastic {
  template <class T>
  SCREE_HD static T force(const KelvinVoigtOf<T>& law, T d) {
    return law.normal_stiffness * d;
  }
  template <class T>
  SCREE_HD static T stiffness(const KelvinVoigtOf<T>& law, T) {
    return law.normal_stiffness;
  }
  SCREE_HD static Real energy(const KelvinVoigt& law, Real d) {
    return Real(0.5) * law.normal_stiffness * d * d;
  }
  // The overlap [m] with this force [N].
  SCREE_HD static Real overlap(const KelvinVoigt& law, Real force) { return force / law.normal_stiffness; }
};

struct PowerElastic {
  template <class T>
  SCREE_HD static T force(const KelvinVoigtOf<T>& law, T d) {
    return law.normal_stiffness * std::pow(d, law.exponent);
  }
  template <class T>
  SCREE_HD static T stiffness(const KelvinVoigtOf<T>& law, T d) {
    return law.normal_stiffness * law.exponent * std::pow(d, law.exponent - 1);
  }
  SCREE_HD static Real energy(const KelvinVoigt& law, Real d) {
    return law.normal_stiffness / (law.exponent + 1) * std::pow(d, law.exponent + 1);
  }
  SCREE_HD static Real overlap(const KelvinVoigt& law, Real force) {
    return std::pow(force / law.normal_stiffness, 1 / law.exponent);
  }
};

// Force of a closed contact: overlap d > 0 [m], overlap rate d_dot [m/s], positive when approaching.
template <class Elastic, class T>
SCREE_HD ContactForceOf<T> contact_force(const KelvinVoigtOf<T>& law, T d, T d_dot) {
  const T elastic = Elastic::force(law, d);
  const T force = elastic + law.normal_damping * d_dot;
  if (force < 0 && !law.tension) return {0, 0, 0, -elastic * d_dot};
  return {force, Elastic::stiffness(law, d), law.normal_damping, law.normal_damping * d_dot * d_dot};
}

// A contact over one time step: at its start (0) and its end (1). Overlaps may be negative: gaps.
struct ContactStep {
  Real overlap0, rate0;  // [m], [m/s]
  Real overlap1, rate1;
  Real h;  // [s]
};

// The force of a contact for a step, and its derivatives with respect to the overlap and its rate at the end.
struct StepContactForce {
  Real force;      // F [N]
  Real stiffness;  // dF/d(overlap1) [N/m]
  Real damping;    // dF/d(rate1) [N s/m]
};

// What the trapezoidal rule must find at the end of the step, in place of the force there, for the step's
// impulse and work to be right although the contact opens or closes within the step:
//   impulse h (F0 + F) / 2 = force summed over the part of the step that is spent in contact.
// With that part from the straight line between the overlaps, the elastic work (F0 + F) / 2 (d1 - d0) is
// exactly the change of the elastic energy: no step size creates energy at impacts. This is the discrete
// gradient of LaBudde and Greenspan (1974) and of Simo, Tarnow and Wong (1992). F is continuous at d1 = 0,
// where the force itself jumps by C d_dot: a Newton loop cannot cycle between open and closed. stiffness and
// damping are cut at 0.

// d0 <= 0 < d1: in contact over the share d1 / (d1 - d0), at the rate (d1 - d0) / h.
template <class Elastic>
SCREE_HD StepContactForce touching_force(const KelvinVoigt& law, const ContactStep& c) {
  const Real travel = c.overlap1 - c.overlap0, twice_damping = 2 * law.normal_damping;
  const Real elastic = 2 * Elastic::energy(law, c.overlap1) / travel;
  const Real slope = (2 * Elastic::force(law, c.overlap1) - elastic) / travel + twice_damping / c.h;
  return {elastic + twice_damping * c.overlap1 / c.h, slope, 0};
}

// d1 <= 0 < d0 with tension: in contact over the share d0 / (d0 - d1).
template <class Elastic>
SCREE_HD StepContactForce releasing_force(const KelvinVoigt& law, const ContactStep& c,
                                          const ContactForce& start) {
  const Real travel = c.overlap0 - c.overlap1, twice_damping = 2 * law.normal_damping;
  const Real elastic = 2 * Elastic::energy(law, c.overlap0) / travel;
  return {elastic - twice_damping * c.overlap0 / c.h - start.force, elastic / travel, 0};
}

// d0 > 0 without tension, the law's force F1 at the end negative (end_force, beyond release along the slope
// at the start): the force falls to zero in a straight line over the share F0 / (F0 - F1).
SCREE_HD StepContactForce fading_force(const ContactForce& start, Real end_force) {
  const Real share = end_force < 0 ? start.force / (start.force - end_force) : 1;
  return {share * start.force - start.force, share * share * start.stiffness, share * share * start.damping};
}

// The contact over a step that may open or close within it.
template <class Elastic>
SCREE_HD StepContactForce step_contact_force(const KelvinVoigt& law, const ContactStep& c) {
  if (c.overlap0 <= 0) return c.overlap1 > 0 ? touching_force<Elastic>(law, c) : StepContactForce{0, 0, 0};
  const ContactForce start = contact_force<Elastic>(law, c.overlap0, c.rate0);
  if (c.overlap1 > 0) {
    const ContactForce end = contact_force<Elastic>(law, c.overlap1, c.rate1);
    if (end.force > 0 || law.tension) return {end.force, end.stiffness, end.damping};
  }
  if (law.tension) return releasing_force<Elastic>(law, c, start);
  const Real stiffness =
      c.overlap1 > 0 ? Elastic::stiffness(law, c.overlap1) : Elastic::stiffness(law, c.overlap0);
  const Real elastic = c.overlap1 > 0 ? Elastic::force(law, c.overlap1) : stiffness * c.overlap1;
  const Real end_force = elastic + law.normal_damping * c.rate1;
  if (end_force > 0) return {end_force, stiffness, law.normal_damping};
  return fading_force(start, end_force);
}

}  // namespace scree
