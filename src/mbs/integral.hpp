// Integrals of functions of time and of curves.
#pragma once

#include <cmath>

#include "model/derived/scalar_function.hpp"

namespace scree {

// Integral of a function between two arguments, by Gauss's rule with three points: exact up to degree 5, the
// degree of the pieces of tables.
inline Real integral(const ScalarFunction& function, Real from, Real to) {
  static const Real kOuter = std::sqrt(Real(0.6));
  const Real middle = (from + to) / 2, half = (to - from) / 2;
  return half / 9 *
         (5 * function(middle - kOuter * half).value + 8 * function(middle).value +
          5 * function(middle + kOuter * half).value);
}

}  // namespace scree
