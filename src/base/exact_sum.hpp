// Sum of doubles as integers, without a preceding pass for the scale: the same bits for any order and any
// partition of the terms.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// The binary digits of all doubles are divided into bins of 32 digits, counted from the smallest. The sum
// keeps the bin with the leading bit of the largest term and the two bins below it; lower bits (below 2^-65
// of that term) are cut off each term. The bins, and what a term adds to them, do not depend on the order:
// sums of parts add up to the bits of the whole. Up to 2^31 terms. Cf. Demmel and Nguyen, IEEE Trans. Comput.
// 64, 2015.
class ExactSum {
 public:
  // Terms that are not finite make the sum a NaN.
  SCREE_HD void add(Real term) {
    std::int64_t bits;
    std::memcpy(&bits, &term, sizeof bits);
    const std::int64_t exponent = bits >> kMantissaBits & kExponentMask;
    if (exponent == 0) return;  // zero, or too small for a normal number
    raise(exponent == kExponentMask ? kNotFinite : exponent / kBinBits);
    if (top_ == kNotFinite) return;
    const std::uint64_t mantissa = (static_cast<std::uint64_t>(bits) & kMantissaMask) | kHiddenBit;
    // The last bit of the mantissa is at digit `exponent` - 52 of all digits; bin k starts at digit 32 k.
    const int past = static_cast<int>(exponent % kBinBits);  // position of the leading bit in its bin
    const int below = kMantissaBits - past;                  // number of bits below that bin
    const std::int64_t sign = bits < 0 ? -1 : 1;
    const std::int64_t depth = top_ - exponent / kBinBits;
    add_piece(depth, sign * static_cast<std::int64_t>(mantissa >> below));
    const std::uint64_t rest = mantissa & ((std::uint64_t(1) << below) - 1);
    if (below <= kBinBits) {
      add_piece(depth + 1, sign * static_cast<std::int64_t>(rest << (kBinBits - below)));
    } else {
      const int last = below - kBinBits;
      add_piece(depth + 1, sign * static_cast<std::int64_t>(rest >> last));
      const std::uint64_t end = rest & ((std::uint64_t(1) << last) - 1);
      add_piece(depth + 2, sign * static_cast<std::int64_t>(end << (kBinBits - last)));
    }
  }
  SCREE_HD void add(const ExactSum& part) {
    raise(part.top_);
    for (int k = 0; k < kBins; ++k) add_piece(top_ - part.top_ + k, part.bin_[k]);
  }
  // The sum, rounded once.
  Real value() const {
    if (top_ == kNotFinite) return NAN;
    if (bin_[0] == 0 && bin_[1] == 0 && bin_[2] == 0) return 0;
    const __int128 whole = ((static_cast<__int128>(bin_[0]) * kBinSize + bin_[1]) * kBinSize) + bin_[2];
    const std::int64_t exponent = kBinBits * (top_ - kBins + 1) - kExponentBias;
    const Real rounded = static_cast<Real>(whole);
    // Where the power of two is a normal number, the product equals ldexp() and is faster.
    if (exponent > -kExponentBias)
      return rounded * std::bit_cast<Real>((exponent + kExponentBias) << kMantissaBits);
    return std::ldexp(rounded, static_cast<int>(exponent));
  }

 private:
  static constexpr int kMantissaBits = 52, kBinBits = 32, kBins = 3, kExponentBias = 1023;
  static constexpr std::int64_t kExponentMask = 0x7ff, kNotFinite = 1 << 20, kBinSize = 1ll << kBinBits;
  static constexpr std::uint64_t kHiddenBit = std::uint64_t(1) << kMantissaBits,
                                 kMantissaMask = kHiddenBit - 1;

  SCREE_HD void raise(std::int64_t top) {
    for (; top_ < top && top - top_ < kBins; ++top_) bin_[2] = bin_[1], bin_[1] = bin_[0], bin_[0] = 0;
    if (top_ >= top) return;
    top_ = top;
    bin_[0] = bin_[1] = bin_[2] = 0;
  }
  SCREE_HD void add_piece(std::int64_t depth, std::int64_t piece) {
    if (depth == 0) bin_[0] += piece;
    if (depth == 1) bin_[1] += piece;
    if (depth == 2) bin_[2] += piece;
  }

  std::int64_t top_ = 0;  // number of the highest bin
  std::int64_t bin_[kBins] = {};
};

}  // namespace scree
