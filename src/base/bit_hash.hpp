// A hash over the bits of values, 64 at a time. A change of any single value changes the hash.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

class BitHash {
 public:
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(Real value) { add(std::bit_cast<std::int64_t>(value)); }
  // The product carries every bit upwards; the shift carries them down again.
  void add(std::int64_t value) {
    hash_ = (hash_ ^ static_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u;
    hash_ ^= hash_ >> 32;
  }
  // Adds bytes in groups of 8; zeros fill up the last group.
  void add(const void* values, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 8) {
      std::int64_t word = 0;
      std::memcpy(&word, static_cast<const std::byte*>(values) + at, std::min<std::size_t>(8, bytes - at));
      add(word);
    }
  }
  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

}  // namespace scree
