// Step limits that follow from the contact law.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "physics/cohesion.hpp"
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

// Recommended steps of velocity Verlet, used where a deck does not give a step: at most these fractions, and
// no longer than trial impacts reproduce the rebound (model/checks/explicit_step.hpp).
inline constexpr Real kStableStepFraction = Real(1) / 3;  // of the stability limit in dense contact
// Of the shortest contact duration, where a JKR contact must break within one step.
inline constexpr Real kPullOffShare = 0.01;
// Recommended phase of a body on its contacts in one step [rad]: its contacts are integrated staggered with
// the particles'.
inline constexpr Real kGoodBodyPhase = 0.3;
// Largest accepted phase; and that between bodies, or bodies and walls, without friction [rad]: beyond it the
// contact gains energy.
inline constexpr Real kMostBodyPhase = 0.7, kMostAmongBodies = 2;

// Reduced mass of two bodies [kg].
SCREE_HD Real reduced_mass(Real a, Real b) { return a * b / (a + b); }

// Stiffness [N/m] for estimates: the slope of K d^n, for n other than 1 at an overlap of 1 % of the smaller
// radius; for plastic pairs that of the first loading.
inline Real loading_stiffness(const NormalLawParameters& of, const PairSize& size) {
  const NormalLawParameters law = law_of_size(of, size);
  // The slope of a cohesive force that decreases with distance must be resolved, too.
  const Real own = of.own->stiffness(size);
  if (law.exponent == 1)
    return std::max({law.normal_stiffness, of.range > 0 ? of.attraction / of.range : 0, own});
  const Real overlap = Real(0.01) * std::min(size.radius_i, size.radius_j);
  if (of.jkr && of.is_cohesive()) return JkrLaw(of).of_pair(size).slope(overlap);
  return std::max(law.normal_stiffness * law.exponent * std::pow(overlap, law.exponent - 1), own);
}
// The largest stiffness at this overlap: for plastic pairs that of unloading.
inline Real typical_stiffness(const NormalLawParameters& of, const PairSize& size) {
  return of.own->unloading_stiffness(loading_stiffness(of, size));
}

// Circular frequency of a single undamped contact [1/s].
SCREE_HD Real contact_frequency(Real stiffness, Real mass) { return std::sqrt(stiffness / mass); }

// Duration of an undamped head-on contact [s]: half a period of the relative motion.
SCREE_HD Real contact_time(Real stiffness, Real reduced_mass) {
  return std::numbers::pi_v<Real> / contact_frequency(stiffness, reduced_mass);
}

// Largest circular frequency of equal particles in the densest lattice [1/s]: sqrt(6 K/m) for discs
// (triangular), sqrt(8 K/m) for spheres (face-centred cubic). There the sum of n n^T over a particle's
// contacts is 3 and 4 times the unit matrix, and the highest mode moves neighbours against each other.
SCREE_HD Real dense_frequency(Real stiffness, Real mass, int dimension) {
  return std::sqrt((dimension == 2 ? 6 : 8) * stiffness / mass);
}

// Largest circular frequency [1/s] of equal particles with friction in the densest lattice: slip_stiffness
// k_t [N/m], inertia_ratio I / (m R^2). It is the higher of two uncoupled modes. In one of them alternate
// layers move tangentially against each other, with two of three contacts between layers; in the other all
// particles spin alike, so that every contact slips by both spins. The squared frequencies are 8 (K + k_t)/m
// and 16 k_t/(m ratio) for spheres, (6 K + 2 k_t)/m and 12 k_t/(m ratio) for discs, with the ratio
// I / (m R^2). rolling_stiffness: k_r / R^2 [N/m]. For two spins a, b a contact's k_t R^2 |a + b|^2 + k_r |a
// - b|^2 is at most twice the larger stiffness times |a|^2 + |b|^2: the larger of k_t and k_r / R^2 is used.
SCREE_HD Real dense_friction_frequency(Real stiffness, Real slip_stiffness, Real mass, Real inertia_ratio,
                                       int dimension, Real rolling_stiffness = 0) {
  const bool discs = dimension == 2;
  const Real moving = discs ? 6 * stiffness + 2 * slip_stiffness : 8 * (stiffness + slip_stiffness);
  const Real rotational = slip_stiffness > rolling_stiffness ? slip_stiffness : rolling_stiffness;
  const Real spinning = (discs ? 12 : 16) * rotational / inertia_ratio;
  return std::sqrt((moving > spinning ? moving : spinning) / mass);
}

// Stability limit [s] of velocity Verlet with damping on the predicted velocity v + h a, for one mode of
// circular frequency w [1/s]: h^2 w^2 / 4 + 2 z h w = 1, where the amplification factor is -1; written as a
// quotient without cancellation at strong damping. stiffness [N/m] and damping [N s/m] of the mode's contacts
// give its damping ratio z = C w / (2 K).
SCREE_HD Real verlet_step_limit(Real frequency, Real stiffness, Real damping) {
  const Real ratio = damping * frequency / (2 * stiffness);
  return 2 / frequency / (std::sqrt(1 + 4 * ratio * ratio) + 2 * ratio);
}

// Tangential stiffness [N/m] for estimates; where it depends on the overlap, at 1 % of the smaller radius.
inline Real typical_slip_stiffness(const Friction& of, const PairSize& size) {
  if (of.friction == 0) return 0;
  const Real overlap = Real(0.01) * std::min(size.radius_i, size.radius_j),
             radius = std::sqrt(size.effective_radius() * overlap);
  if (of.own) return of.own->slip_stiffness(radius);
  if (of.shear_modulus == 0) return LinearSlider::of(of).stiffness_at(0);
  return MindlinSlider::of(of).stiffness_at(radius);
}

// Rolling and twisting stiffness for estimates, k_r / R^2 [N/m], R the smaller radius; stiffness: of the
// normal spring [N/m]. Twisting, R* d k_t / 2 at d = 1 % of the radius, is below 1 % of k_t R^2 and
// neglected.
inline Real typical_rolling_stiffness(const RollingParameters& of, const PairSize& size, Real stiffness) {
  const Real radius = std::min(size.radius_i, size.radius_j);
  if (of.own) return of.own->rolling_stiffness(size, stiffness) / (radius * radius);
  if (of.friction == 0) return 0;
  return AnyRolling::of(of).rolling.stiffness_at(size, stiffness) / (radius * radius);
}

// Largest circular frequency [1/s] of one particle with friction on an immovable partner: normal, tangential
// with rotation, or rolling mode.
inline Real wall_friction_frequency(Real stiffness, Real slip_stiffness, Real mass, Real inertia_ratio,
                                    Real rolling_stiffness = 0) {
  const Real tangential = (1 + 1 / inertia_ratio) * slip_stiffness + rolling_stiffness / inertia_ratio;
  return std::sqrt(std::max(stiffness, tangential) / mass);
}

// Stability limit [s] of the steps of rotating particles, with damping on the mid-step velocities, for modes
// of at most this circular frequency w [1/s] and decay 2 z w [1/s]: h^2 w^2 / 4 + z h w = 1.
inline Real leapfrog_step_limit(Real frequency, Real decay) {
  const Real ratio = decay / (2 * frequency);
  return 2 / frequency / (std::sqrt(1 + ratio * ratio) + ratio);
}

}  // namespace scree
