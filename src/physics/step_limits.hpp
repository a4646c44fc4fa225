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

// What steps of velocity-verlet are good, and are chosen where a deck leaves its step out: at most these
// shares, and no longer than trial impacts keep their rebounds (model/checks/explicit_step.hpp).
inline constexpr Real kStableShare = Real(1) / 3;  // of the stability limit in dense contact
inline constexpr Real kNeckShare = 0.01;  // of the shortest contact, where a neck must let go within one
// Phase that a body on its contacts turns in a step [rad]: its contacts are staggered with the particles'.
inline constexpr Real kGoodBodyPhase = 0.3;
// The largest that is accepted; and between bodies, or bodies and walls, without friction: past it the
// contact gains energy.
inline constexpr Real kMostBodyPhase = 0.7, kMostAmongBodies = 2;

// Mass of the relative motion of two bodies [kg].
SCREE_HD Real reduced_mass(Real a, Real b) { return a * b / (a + b); }

// Stiffness [N/m] for estimates: the slope of K d^n, for n other than 1 at an overlap of 1 % of the smaller
// radius.
inline Real typical_stiffness(const KelvinVoigt& of, const PairSize& size) {
  const KelvinVoigt law = of.of_size(size);
  // An attraction that falls off must be followed, too.
  if (law.exponent == 1) return std::max(law.normal_stiffness, of.range > 0 ? of.attraction / of.range : 0);
  const Real overlap = Real(0.01) * std::min(size.radius_i, size.radius_j);
  if (of.neck && of.attracts()) return JkrLaw(of).of_pair(size).slope(overlap);
  return law.normal_stiffness * law.exponent * std::pow(overlap, law.exponent - 1);
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

// The same where they rub: slip_stiffness k_t [N/m], inertia_share I / (m R^2). The higher of two modes,
// which do not mix. In one every second layer moves across itself against its neighbours, to which two of
// three contacts lead; in the other all spin alike, so that every contact slips by both spins. Their squares
// are 8 (K + k_t)/m and 16 k_t/(m share) for spheres, (6 K + 2 k_t)/m and 12 k_t/(m share) for discs.
// rolling_stiffness: k_r / R^2 [N/m], of springs against rolling. A contact's k_t R^2 |a + b|^2 + k_r |a -
// b|^2 of two spins is at most twice the larger stiffness times |a|^2 + |b|^2: it stands for k_t where it is
// larger.
SCREE_HD Real dense_rubbing_frequency(Real stiffness, Real slip_stiffness, Real mass, Real inertia_share,
                                      int dimension, Real rolling_stiffness = 0) {
  const bool discs = dimension == 2;
  const Real moving = discs ? 6 * stiffness + 2 * slip_stiffness : 8 * (stiffness + slip_stiffness);
  const Real turned = slip_stiffness > rolling_stiffness ? slip_stiffness : rolling_stiffness;
  const Real spinning = (discs ? 12 : 16) * turned / inertia_share;
  return std::sqrt((moving > spinning ? moving : spinning) / mass);
}

// Stability limit [s] of velocity Verlet, whose damping acts on the predicted velocity v + h a, for one mode
// of circular frequency w [1/s]: h^2 w^2 / 4 + 2 z h w = 1, where the mode's amplification is -1; as a
// quotient, in which nothing cancels however strong the damping is. stiffness [N/m] and damping [N s/m] of
// the mode's contacts give its damping ratio z = C w / (2 K).
SCREE_HD Real verlet_step_limit(Real frequency, Real stiffness, Real damping) {
  const Real ratio = damping * frequency / (2 * stiffness);
  return 2 / frequency / (std::sqrt(1 + 4 * ratio * ratio) + 2 * ratio);
}

// Stiffness of the tangential spring [N/m] for estimates: where it depends on the overlap, at 1 % of the
// smaller radius.
inline Real typical_slip_stiffness(const Friction& of, const PairSize& size) {
  if (of.friction == 0) return 0;
  if (of.shear_modulus == 0) return LinearSlider::of(of).stiffness_at(0);
  const Real overlap = Real(0.01) * std::min(size.radius_i, size.radius_j);
  return MindlinSlider::of(of).stiffness_at(std::sqrt(size.effective_radius() * overlap));
}

// Stiffness against rolling and twisting for estimates, k_r / R^2 [N/m], R the smaller radius; stiffness: of
// the normal spring [N/m]. Twisting's, R* d k_t / 2 at d = 1 % of the radius, is below 1 % of k_t R^2 and
// left out.
inline Real typical_rolling_stiffness(const RollingResistance& of, const PairSize& size, Real stiffness) {
  if (of.friction == 0) return 0;
  const Real radius = std::min(size.radius_i, size.radius_j);
  return AnyRolling::of(of).rolling.stiffness_at(size, stiffness) / (radius * radius);
}

// Likewise of one particle on what does not give way: it moves along the normal, or across it and turns, or
// rolls.
inline Real wall_rubbing_frequency(Real stiffness, Real slip_stiffness, Real mass, Real inertia_share,
                                   Real rolling_stiffness = 0) {
  const Real turning = (1 + 1 / inertia_share) * slip_stiffness + rolling_stiffness / inertia_share;
  return std::sqrt(std::max(stiffness, turning) / mass);
}

// Stability limit [s] of the steps of particles that rotate, whose damping acts on the velocities of the
// middle of the step, for modes of at most this circular frequency w [1/s] and decay 2 z w [1/s]:
// h^2 w^2 / 4 + z h w = 1.
inline Real leapfrog_step_limit(Real frequency, Real decay) {
  const Real ratio = decay / (2 * frequency);
  return 2 / frequency / (std::sqrt(1 + ratio * ratio) + ratio);
}

}  // namespace scree
