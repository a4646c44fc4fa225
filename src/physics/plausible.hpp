// Estimates for plausibility checks of a model.
#pragma once

#include <cmath>
#include <numbers>

#include "base/types.hpp"
#include "physics/contact_parameters.hpp"

namespace scree {

// Static overlap of a contact under a weight [m]; weight [N].
inline Real static_overlap(const NormalLawParameters& law, Real weight) {
  return std::pow(weight / law.normal_stiffness, 1 / law.exponent);
}

// Largest overlap of an undamped head-on impact [m]: K d^(n + 1) / (n + 1) = m v^2 / 2. mass: effective mass
// [kg]; speed [m/s].
inline Real impact_overlap(const NormalLawParameters& law, Real mass, Real speed) {
  const Real n = law.exponent;
  return std::pow((n + 1) * mass * speed * speed / (2 * law.normal_stiffness), 1 / (n + 1));
}

// Duration of an undamped head-on impact [s].
inline Real impact_time(const NormalLawParameters& law, Real mass, Real speed) {
  const Real power = law.exponent + 1;
  return 2 * impact_overlap(law, mass, speed) / speed * std::sqrt(std::numbers::pi_v<Real>) *
         std::tgamma(1 + 1 / power) / std::tgamma(Real(0.5) + 1 / power);
}

// Speed of the undamped head-on impact with this largest overlap [m/s].
inline Real overlapping_speed(const NormalLawParameters& law, Real mass, Real overlap) {
  const Real n = law.exponent;
  return std::sqrt(2 * law.normal_stiffness * std::pow(overlap, n + 1) / ((n + 1) * mass));
}

// Damping over critical damping, at which a contact does not rebound [-]. stiffness [N/m]; mass: effective
// mass [kg].
inline Real damping_ratio(Real damping, Real stiffness, Real mass) {
  return damping / (2 * std::sqrt(stiffness * mass));
}

// Speed [m/s] after a fall from rest; gravity [m/s^2], height [m].
inline Real fall_speed(Real gravity, Real height) { return std::sqrt(2 * gravity * height); }

// Radius of gyration [m].
inline Real radius_of_gyration(Real inertia, Real mass) { return std::sqrt(inertia / mass); }

}  // namespace scree
