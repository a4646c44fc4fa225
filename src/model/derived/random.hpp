// Random numbers that are equal on every platform: the standard specifies std::mt19937_64, but not the
// distributions of <random>.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "base/types.hpp"

namespace scree {

class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : generator_(seed) {}

  // In [0, 1): the upper 53 bits.
  Real uniform() { return static_cast<Real>(generator_() >> 11) * 0x1p-53; }
  Real uniform(Real low, Real high) { return low + (high - low) * uniform(); }

  // Mean 0, standard deviation 1: polar method (Marsaglia, Bray, SIAM Review 6, 1964); only one of its two
  // numbers is used.
  Real normal() {
    for (;;) {
      const Real u = uniform(-1, 1), v = uniform(-1, 1), s = u * u + v * v;
      if (s > 0 && s < 1) return u * std::sqrt(-2 * std::log(s) / s);
    }
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace scree
