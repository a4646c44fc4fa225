// The stiffness of a pair of materials from those of each with itself.
#pragma once

#include <cmath>

#include "base/types.hpp"

namespace scree {

// K of two springs F = K d^n in series, each of which is half of a like pair's: at one force the overlap is
// the mean of the overlaps of the like pairs, K^(-1/n) = (K_a^(-1/n) + K_b^(-1/n)) / 2 [N/m^n]. Both above 0,
// or both 0.
inline Real in_series(Real a, Real b, Real exponent = 1) {
  if (a == b) return a;
  if (exponent == 1) return 2 * a * b / (a + b);
  return std::pow((std::pow(a, -1 / exponent) + std::pow(b, -1 / exponent)) / 2, -exponent);
}

}  // namespace scree
