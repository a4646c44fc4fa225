// Stiffness of a pair of unlike materials from those of the like pairs.
#pragma once

#include <cmath>

#include "base/types.hpp"

namespace scree {

// K of two springs F = K d^n in series, each half of a like pair [N/m^n]: at equal force the overlap is the
// mean of the overlaps of the like pairs, K^(-1/n) = (K_a^(-1/n) + K_b^(-1/n)) / 2. Both are above 0, or both
// are 0.
inline Real in_series(Real a, Real b, Real exponent = 1) {
  if (a == b) return a;
  if (exponent == 1) return 2 * a * b / (a + b);
  return std::pow((std::pow(a, -1 / exponent) + std::pow(b, -1 / exponent)) / 2, -exponent);
}

}  // namespace scree
