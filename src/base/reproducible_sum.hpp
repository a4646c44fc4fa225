// Sum of many doubles with the same bits for any order and any partition over ranks or threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// Terms are rounded to multiples of a quantum, 2^-62 of the largest magnitude, and added as integers. Two
// passes: the maximum, then the integers, both exact in any order. Up to 2^64 terms.
class ReproducibleScale {
 public:
  // largest: an upper bound of |term|, equal on every rank.
  ReproducibleScale() = default;
  SCREE_HD explicit ReproducibleScale(Real largest) : usable_(std::isfinite(largest)) {
    constexpr int kLargestShift = 1000;  // terms far below the resolution count as zero
    int exponent = 0;
    if (usable_) std::frexp(largest, &exponent);
    const int shift = 62 - exponent < kLargestShift ? 62 - exponent : kLargestShift;
    scale_ = std::ldexp(Real(1), shift), inverse_ = std::ldexp(Real(1), -shift);
  }
  // |term * scale| < 2^62: a term fits into 64 bits, the sum into 128 bits.
  SCREE_HD std::int64_t quanta(Real term) const {
    return usable_ ? static_cast<std::int64_t>(term * scale_) : 0;
  }
  Real value(__int128 quanta) const { return usable_ ? static_cast<Real>(quanta) * inverse_ : NAN; }

 private:
  bool usable_ = false;
  Real scale_ = 1, inverse_ = 1;
};

// Reduction over a single process.
struct OneProcess {
  void max(std::span<Real>) const {}
  void sum(std::span<__int128>) const {}
};

// Sums of N terms each: item(i).value[k] for i = 0 ... n-1, which are evaluated twice. over: reduces maxima
// and sums over all processes, each with its own items; all of them get the sums.
template <int N, class Item, class Over = OneProcess>
void reproducible_sums(Index n, const Item& item, Real (&sums)[N], const Over& over = {}) {
  Real largest[N] = {};
  for (Index i = 0; i < n; ++i) {
    const auto terms = item(i);
    for (int k = 0; k < N; ++k) {
      const Real magnitude = std::abs(terms.value[k]);
      if (!(magnitude <= largest[k]) && !std::isnan(largest[k])) largest[k] = magnitude;  // a NaN persists
    }
  }
  over.max(std::span<Real>(largest));
  ReproducibleScale scale[N];
  for (int k = 0; k < N; ++k) scale[k] = ReproducibleScale(largest[k]);
  __int128 quanta[N] = {};
  for (Index i = 0; i < n; ++i) {
    const auto terms = item(i);
    for (int k = 0; k < N; ++k) quanta[k] += scale[k].quanta(terms.value[k]);
  }
  over.sum(std::span<__int128>(quanta));
  for (int k = 0; k < N; ++k) sums[k] = scale[k].value(quanta[k]);
}

}  // namespace scree
