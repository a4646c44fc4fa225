// Damping ratio and coefficient of restitution of a contact: each is a function of the other alone.
//   F = K d^n + c d^((n-1)/2) d_dot,  c = 2 zeta sqrt(m* K (n+1)/2),  m* the reduced mass
// With dtau = d^((n-1)/2) dt and y = 2/(n+1) d^((n+1)/2) the velocity is dy/dtau, and y obeys a linear
// oscillator of damping ratio zeta for all n: the restitution depends on neither speed, stiffness nor
// exponent. Linear, n = 1: c = 2 zeta sqrt(m* K). Hertz, n = 3/2: c = sqrt(5) zeta sqrt(m* K), as in Antypov
// and Elliott, EPL 94 (2011).
#pragma once

#include <cmath>
#include <numbers>

#include "base/types.hpp"

namespace scree {

// Duration in tau of a contact whose force is cut at zero, in units of the inverse undamped frequency: 2
// acos(zeta) / sqrt(1 - zeta^2), and its analytic continuation beyond critical damping.
inline Real cut_contact_time(Real damping_ratio) {
  const Real below = (1 - damping_ratio) * (1 + damping_ratio), s = std::sqrt(std::abs(below));
  if (s == 0) return 2;
  return 2 * (below > 0 ? std::atan2(s, damping_ratio) : std::asinh(s)) / s;
}

// Damping ratio of a coefficient of restitution in (0, 1]. tension: the force may be tensile until the
// overlap is zero; else it is cut at zero, before that.
inline Real damping_ratio_of(Real restitution, bool tension) {
  const Real decay = -std::log(restitution);
  if (tension) return decay / std::hypot(std::numbers::pi_v<Real>, decay);
  if (!(decay > 0)) return 0;
  // zeta times the duration grows with zeta; for zeta >= 1 the restitution is less than 1 / zeta^2.
  Real low = 0, high = restitution < 1 ? 1 / std::sqrt(restitution) : 1;
  for (;;) {
    const Real middle = low + (high - low) / 2;
    if (!(low < middle && middle < high)) return middle;
    (middle * cut_contact_time(middle) < decay ? low : high) = middle;
  }
}

}  // namespace scree
