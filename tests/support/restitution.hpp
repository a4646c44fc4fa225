// The inverse of physics/restitution.hpp: damping and restitution of a damping ratio.
#pragma once

#include <cmath>
#include <numbers>

#include "base/types.hpp"
#include "physics/restitution.hpp"

namespace scree {

// c of a damping ratio [N s/m^((n+1)/2)]; stiffness K [N/m^n].
inline Real contact_damping(Real damping_ratio, Real reduced_mass, Real stiffness, Real exponent) {
  return 2 * damping_ratio * std::sqrt(reduced_mass * stiffness * (exponent + 1) / 2);
}

// Coefficient of restitution of a damping ratio >= 0. tension: the force may be tensile until the overlap is
// zero; else it is cut at zero, before that. With tension there is no rebound at or above critical damping.
inline Real restitution_of(Real damping_ratio, bool tension) {
  if (!tension) return std::exp(-damping_ratio * cut_contact_time(damping_ratio));
  if (damping_ratio >= 1) return 0;
  return std::exp(-std::numbers::pi_v<Real> * damping_ratio /
                  std::sqrt((1 - damping_ratio) * (1 + damping_ratio)));
}

}  // namespace scree
