// Cube root, exponential function, logarithm and arc tangent of + - * / and square roots alone, which have
// the same bits on CPU and GPU; the libraries' functions differ there. Relative errors are below 1e-14.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// Cube root of x > 0 by Newton's method, whose iterates decrease after the first one.
SCREE_HD Real cube_root(Real x) {
  const Real fourth = std::sqrt(std::sqrt(x));
  Real y = fourth * std::sqrt(std::sqrt(fourth));  // x^(5/16)
  y = (2 * y + x / (y * y)) / 3;
  for (Real next = y;; y = next) {
    next = (2 * y + x / (y * y)) / 3;
    if (!(next < y)) return y;
  }
}

// Polynomial with these coefficients, that of the lowest power first.
template <class... More>
SCREE_HD Real polynomial(Real x, Real first, More... more) {
  if constexpr (sizeof...(more) == 0)
    return first;
  else
    return first + x * polynomial(x, more...);
}

// ln 2, as a number with 20 zeros at its end, whose small multiples are exact, and the rest.
inline constexpr Real kLn2 = 0x1.62e42fefa39efp-1, kLn2High = 0x1.62e42ffp-1,
                      kLn2Low = -0x1.718432a1b0e26p-35;

// e^x for |x| <= 700; 0 below.
SCREE_HD Real exponential(Real x) {
  if (x < -700) return 0;
  const Real k = std::floor(x / kLn2 + Real(0.5)), r = (x - k * kLn2High) - k * kLn2Low;  // |r| <= ln(2)/2
  const Real series =
      polynomial(r, 1.0, 1.0, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320,
                 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800);
  return std::ldexp(series, static_cast<int>(k));
}

// ln x for normal x > 0.
SCREE_HD Real logarithm(Real x) {
  int k = 0;
  Real m = std::frexp(x, &k);  // in [1/2, 1)
  if (m < Real(0.70710678118654752)) m *= 2, --k;
  const Real z = (m - 1) / (m + 1), y = z * z;  // ln m = 2 artanh z, |z| <= 0.172
  const Real series = polynomial(y, 1.0, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15,
                                 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23);
  return k * kLn2High + (k * kLn2Low + 2 * z * series);
}

// arctan x for |x| < 1e150. The angle is halved three times, to below pi/16.
SCREE_HD Real arc_tangent(Real x) {
  for (int k = 0; k < 3; ++k) x = x / (1 + std::sqrt(1 + x * x));
  const Real y = x * x;
  return 8 * x *
         polynomial(y, 1.0, -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15, 1.0 / 17,
                    -1.0 / 19, 1.0 / 21, -1.0 / 23);
}

}  // namespace scree
