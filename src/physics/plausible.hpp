// Estimates that tell a plausible model from one with a slip in its numbers.
#pragma once

#include <cmath>
#include <numbers>

#include "base/types.hpp"
#include "physics/normal_laws.hpp"

namespace scree {

// Overlap at which a contact carries a weight [m]; weight [N].
inline Real resting_overlap(const KelvinVoigt& law, Real weight) {
  return std::pow(weight / law.normal_stiffness, 1 / law.exponent);
}

// Largest overlap of an undamped head-on impact [m]: where K d^(n + 1) / (n + 1) is m v^2 / 2. mass: of the
// relative motion [kg]; speed [m/s].
inline Real impact_overlap(const KelvinVoigt& law, Real mass, Real speed) {
  const Real n = law.exponent;
  return std::pow((n + 1) * mass * speed * speed / (2 * law.normal_stiffness), 1 / (n + 1));
}

// Duration of that impact [s].
inline Real impact_time(const KelvinVoigt& law, Real mass, Real speed) {
  const Real power = law.exponent + 1;
  return 2 * impact_overlap(law, mass, speed) / speed * std::sqrt(std::numbers::pi_v<Real>) *
         std::tgamma(1 + 1 / power) / std::tgamma(Real(0.5) + 1 / power);
}

// Speed of an undamped head-on impact that ends in this overlap [m/s].
inline Real overlapping_speed(const KelvinVoigt& law, Real mass, Real overlap) {
  const Real n = law.exponent;
  return std::sqrt(2 * law.normal_stiffness * std::pow(overlap, n + 1) / ((n + 1) * mass));
}

// Damping of a contact over the critical one, at which nothing rebounds [-]. stiffness [N/m], mass of the
// relative motion [kg].
inline Real damping_ratio(Real damping, Real stiffness, Real mass) {
  return damping / (2 * std::sqrt(stiffness * mass));
}

// Speed [m/s] after a fall from rest; gravity [m/s^2], height [m].
inline Real fall_speed(Real gravity, Real height) { return std::sqrt(2 * gravity * height); }

// Distance from the axis at which a point mass has the moment of inertia [m].
inline Real radius_of_gyration(Real inertia, Real mass) { return std::sqrt(inertia / mass); }

}  // namespace scree
