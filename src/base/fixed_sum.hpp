// Sum of doubles in fixed-point format, usable over a complete run and beyond: the same bits for any order
// and any partition of the terms, over ranks, restarts, and threads that add concurrently.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// Limbs of 32 binary digits, the lowest digit 2^-96. Each term is truncated there, adds an integer to at most
// three limbs, and must be below 2^32 in magnitude. Beside the limbs is the number of terms that are larger
// or not finite, which make the sum a NaN. Between two calls of normalize() the limbs can take kMostTerms
// terms. Unlike ExactSum it does not depend on the largest term, and the limbs of partial sums are combined
// by integer addition, atomic or not.
class FixedSum {
 public:
  static constexpr int kLimbs = 4, kBad = kLimbs, kNumbers = kLimbs + 1;
  static constexpr std::int64_t kMostTerms = (std::int64_t{1} << 31) - 1;  // between two normalize()

  // Calls put(limb, integer) for what the term adds to the limbs.
  template <class Put>
  SCREE_HD static void for_each_piece(Real term, const Put& put) {
    std::int64_t bits;
    std::memcpy(&bits, &term, sizeof bits);
    const auto exponent = static_cast<int>(bits >> kMantissaBits & kExponentMask);
    if (exponent >= kTooLarge) return put(kBad, std::int64_t{1});
    int digit = exponent - kLowestDigit;  // of the mantissa's last bit, counted from the lowest digit
    if (exponent == 0 || digit <= -kMantissaBits - 1) return;
    std::uint64_t mantissa = (static_cast<std::uint64_t>(bits) & kMantissaMask) | kHiddenBit;
    if (digit < 0) mantissa >>= -digit, digit = 0;
    const int first = digit / kLimbBits, shift = digit % kLimbBits;
    const std::int64_t sign = bits < 0 ? -1 : 1;
    // The mantissa's at most 84 digits, from the first limb on.
    const std::uint64_t pieces[] = {mantissa << shift & kLimbMask,
                                    mantissa >> (kLimbBits - shift) & kLimbMask,
                                    mantissa >> kLimbBits >> (kLimbBits - shift)};
    for (int k = 0; k < 3; ++k)
      if (pieces[k] != 0) put(first + k, sign * static_cast<std::int64_t>(pieces[k]));
  }

  SCREE_HD void add(Real term) {
    for_each_piece(term, [this](int k, std::int64_t piece) { word[k] += piece; });
  }
  void add(const FixedSum& part) {
    for (int k = 0; k < kNumbers; ++k) word[k] += part.word[k];
  }
  // Carries the digits beyond the size of a limb to the next limb; the result is the unique normalized form
  // of the number.
  SCREE_HD void normalize() {
    for (int k = 0; k + 1 < kLimbs; ++k) {
      const std::int64_t past = word[k] >> kLimbBits;  // rounded down
      word[k] -= past * (std::int64_t{1} << kLimbBits), word[k + 1] += past;
    }
  }
  // The sum, rounded once.
  Real value() const {
    if (word[kBad] != 0) return NAN;
    FixedSum sum = *this;
    sum.normalize();
    __int128 whole = sum.word[3];
    whole = (whole << kLimbBits) + sum.word[2], whole = (whole << kLimbBits) + sum.word[1];
    const bool fits = whole >> 94 == 0 || whole >> 94 == -1;
    if (fits) return std::ldexp(static_cast<Real>((whole << kLimbBits) + sum.word[0]), -3 * kLimbBits);
    // The lowest limb is below the 94 leading bits: for rounding it matters only whether it is zero.
    return std::ldexp(static_cast<Real>(whole | (sum.word[0] != 0)), -2 * kLimbBits);
  }

  std::int64_t word[kNumbers] = {};  // limbs, the lowest first; number of invalid terms

 private:
  static constexpr int kMantissaBits = 52, kLimbBits = 32, kExponentBias = 1023, kExponentMask = 0x7ff;
  static constexpr int kTooLarge = kExponentBias + 32;  // exponent of 2^32
  static constexpr int kLowestDigit = kExponentBias + kMantissaBits - 3 * kLimbBits;
  static constexpr std::uint64_t kLimbMask = (std::uint64_t(1) << kLimbBits) - 1,
                                 kHiddenBit = std::uint64_t(1) << kMantissaBits,
                                 kMantissaMask = kHiddenBit - 1;
};

}  // namespace scree
