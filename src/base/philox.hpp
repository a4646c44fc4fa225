// The counter-based random generator Philox4x32-10 (Salmon, Moraes, Dror, Shaw, SC11, 2011): a bijection of
// 128-bit counters that depends on a 64-bit key. It has no state, so any number of a sequence can be computed
// by any rank and on any device.
#pragma once

#include <cstdint>

#include "base/hd.hpp"

namespace scree {

struct PhiloxBlock {
  std::uint32_t word[4];  // from the lowest to the highest
};

struct PhiloxKey {
  std::uint32_t word[2];
};

// The random block of a counter.
SCREE_HD constexpr PhiloxBlock philox4x32(PhiloxBlock counter, PhiloxKey key) {
  constexpr std::uint64_t kMultiplier0 = 0xD2511F53, kMultiplier1 = 0xCD9E8D57;
  // Increments of the key: the golden ratio and sqrt(3) - 1.
  constexpr std::uint32_t kWeyl0 = 0x9E3779B9, kWeyl1 = 0xBB67AE85;
  constexpr int kRounds = 10;
  std::uint32_t(&c)[4] = counter.word;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = kMultiplier0 * c[0], product1 = kMultiplier1 * c[2];
    c[0] = static_cast<std::uint32_t>(product1 >> 32) ^ c[1] ^ key.word[0];
    c[1] = static_cast<std::uint32_t>(product1);
    c[2] = static_cast<std::uint32_t>(product0 >> 32) ^ c[3] ^ key.word[1];
    c[3] = static_cast<std::uint32_t>(product0);
    key.word[0] += kWeyl0, key.word[1] += kWeyl1;
  }
  return counter;
}

}  // namespace scree
