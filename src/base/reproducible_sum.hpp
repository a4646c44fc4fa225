// Sum of many doubles that gives the same bits in any order and for any split over ranks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/types.hpp"

namespace scree {

// Terms are rounded to multiples of a quantum 2^-62 below the largest magnitude and added as integers.
// Two passes: the maximum (exact in any order), then the integers (exact in any order). Up to 2^64 terms.
class ReproducibleSum {
 public:
  // largest: an upper bound on |term|, the same on every rank.
  explicit ReproducibleSum(Real largest) : usable_(std::isfinite(largest)) {
    int exponent = 0;
    if (usable_) std::frexp(largest, &exponent);
    const int shift = std::min(62 - exponent, kLargestShift);
    scale_ = std::ldexp(Real(1), shift), inverse_scale_ = std::ldexp(Real(1), -shift);
  }
  // |term * scale| < 2^62: it fits into 64 bits, the sum into 128.
  void add(Real term) {
    if (usable_) sum_ += static_cast<std::int64_t>(term * scale_);
  }
  Real value() const { return usable_ ? static_cast<Real>(sum_) * inverse_scale_ : NAN; }

 private:
  static constexpr int kLargestShift = 1000;  // tinier terms than this resolves are as good as zero
  bool usable_;
  Real scale_ = 1, inverse_scale_ = 1;
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
