// Damping ratio and coefficient of restitution of a contact: each is a function of the other alone.
//   F = K d^n + c d^((n-1)/2) d_dot,  c = 2 zeta sqrt(m* K (n+1)/2),  m* the reduced mass
// With dtau = d^((n-1)/2) dt and y = 2/(n+1) d^((n+1)/2) the velocity is dy/dtau, and y obeys a linear
// oscillator of damping ratio zeta whatever n is: a rebound depends on neither speed, stiffness nor exponent.
// Linear, n = 1: c = 2 zeta sqrt(m* K). Hertz, n = 3/2: c = sqrt(5) zeta sqrt(m* K), for which Antypov and
// Elliott, EPL 94 (2011), find the same.
#pragma once

#include <cmath>
#include <numbers>

#include "base/types.hpp"

namespace scree {

// c of a damping ratio [N s/m^((n+1)/2)]; stiffness K [N/m^n].
inline Real contact_damping(Real damping_ratio, Real reduced_mass, Real stiffness, Real exponent) {
  return 2 * damping_ratio * std::sqrt(reduced_mass * stiffness * (exponent + 1) / 2);
}

// Time in tau over which a force that is cut at zero acts, in units of the inverse undamped frequency:
// 2 acos(zeta) / sqrt(1 - zeta^2), and what that goes over into beyond critical damping.
inline Real cut_contact_time(Real damping_ratio) {
  const Real below = (1 - damping_ratio) * (1 + damping_ratio), s = std::sqrt(std::abs(below));
  if (s == 0) return 2;
  return 2 * (below > 0 ? std::atan2(s, damping_ratio) : std::asinh(s)) / s;
}

// Coefficient of restitution of a damping ratio >= 0. tension: the force may pull until the overlap is zero;
// else it is cut at zero, before that. With tension nothing rebounds from critical damping on.
inline Real restitution_of(Real damping_ratio, bool tension) {
  if (!tension) return std::exp(-damping_ratio * cut_contact_time(damping_ratio));
  if (damping_ratio >= 1) return 0;
  return std::exp(-std::numbers::pi_v<Real> * damping_ratio /
                  std::sqrt((1 - damping_ratio) * (1 + damping_ratio)));
}

// Damping ratio of a coefficient of restitution in (0, 1].
inline Real damping_ratio_of(Real restitution, bool tension) {
  const Real decay = -std::log(restitution);
  if (tension) return decay / std::hypot(std::numbers::pi_v<Real>, decay);
  if (!(decay > 0)) return 0;
  // zeta times the time grows with zeta; from zeta = 1 on the rebound is less than 1 / zeta^2.
  Real low = 0, high = restitution < 1 ? 1 / std::sqrt(restitution) : 1;
  for (;;) {
    const Real middle = low + (high - low) / 2;
    if (!(low < middle && middle < high)) return middle;
    (middle * cut_contact_time(middle) < decay ? low : high) = middle;
  }
}

}  // namespace scree
