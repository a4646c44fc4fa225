// Random numbers that depend on a seed, a purpose and an index alone: the numbers of particle i are the same
// on every rank, in every order and after a restart, and on every platform.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/elementary.hpp"
#include "base/philox.hpp"
#include "base/types.hpp"

namespace scree {

// Purposes of random numbers. Different purposes have independent numbers for the same seed and index. The
// values must not change: they determine all random particles.
enum class RandomStream : std::uint32_t {
  radius = 1,
  mass = 2,
  density = 3,
  mixture_class = 7,  // of a particle of a mixture
  birth = 8,          // position and velocity of an inserted particle
  test = 9
};

// A sequence of random numbers for one index, such as a particle's within its group. Equal arguments give
// equal sequences.
class CounterRandom {
 public:
  // index: from 0.
  CounterRandom(std::uint64_t seed, RandomStream stream, std::int64_t index)
      : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}},
        index_(static_cast<std::uint64_t>(index)),
        stream_(static_cast<std::uint32_t>(stream)) {}

  // In [0, 1): a multiple of 2^-53.
  Real uniform() {
    if (drawn_ % 2 == 0) block_ = block(drawn_ / 2);
    const std::uint32_t* half = block_.word + 2 * (drawn_++ % 2);
    const std::uint64_t bits = static_cast<std::uint64_t>(half[1]) << 32 | half[0];
    return static_cast<Real>(bits >> 11) * 0x1p-53;
  }
  Real uniform(Real low, Real high) { return low + (high - low) * uniform(); }

  // Mean 0, standard deviation 1: polar method (Marsaglia, Bray, SIAM Review 6, 1964); only one of its two
  // numbers is used.
  Real normal() {
    for (;;) {
      const Real u = uniform(-1, 1), v = uniform(-1, 1), s = u * u + v * v;
      if (s > 0 && s < 1) return u * std::sqrt(-2 * logarithm(s) / s);
    }
  }

 private:
  // The counter: index in 64 bits, number of the block in 48 bits, stream in 16 bits.
  PhiloxBlock block(std::uint64_t number) const {
    return philox4x32(
        {{static_cast<std::uint32_t>(index_), static_cast<std::uint32_t>(index_ >> 32),
          static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32) | stream_ << 16}},
        key_);
  }

  PhiloxKey key_;
  std::uint64_t index_, drawn_ = 0;  // numbers drawn so far
  std::uint32_t stream_;
  PhiloxBlock block_{};
};

}  // namespace scree
