// Sum of many doubles that gives the same bits in any order and for any split over ranks.
#pragma once

#include <cmath>
#include <span>

#include "base/types.hpp"

namespace scree {

// Terms are rounded to multiples of a quantum 2^-62 below the largest magnitude and added as 128-bit integers.
// Two passes: the maximum (exact in any order), then the integers (exact in any order). Up to 2^64 terms.
class ReproducibleSum {
 public:
  // largest: an upper bound on |term|, the same on every rank.
  explicit ReproducibleSum(Real largest) : shift_(62 - exponent(largest)), usable_(std::isfinite(largest)) {}
  void add(Real term) {
    if (usable_) sum_ += static_cast<__int128>(std::ldexp(term, shift_));
  }
  Real value() const { return usable_ ? std::ldexp(static_cast<Real>(sum_), -shift_) : NAN; }

 private:
  static int exponent(Real largest) {
    int e = 0;
    if (std::isfinite(largest)) std::frexp(largest, &e);
    return e;
  }
  int shift_;
  bool usable_;
  __int128 sum_ = 0;
};

// term(i) for i = 0 ... n-1, evaluated twice.
template <class Term>
Real reproducible_sum(Index n, const Term& term) {
  Real largest = 0;
  for (Index i = 0; i < n; ++i) {
    const Real magnitude = std::abs(term(i));
    if (!(magnitude <= largest) && !std::isnan(largest)) largest = magnitude;  // a NaN sticks
  }
  ReproducibleSum sum(largest);
  for (Index i = 0; i < n; ++i) sum.add(term(i));
  return sum.value();
}

}  // namespace scree
