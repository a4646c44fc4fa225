// Values compared bit for bit: -0.0 is not 0.0, and a NaN is itself.
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstdint>
#include <iterator>
#include <ranges>
#include <tuple>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

inline bool same_bits(Real a, Real b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(std::integral auto a, std::integral auto b) { return a == b; }

// Bits of a struct, for which fields() gives a tuple of its members: by structured binding, so that a member
// that is forgotten here does not compile.
inline auto fields(const Vec3& v) {
  const auto& [x, y, z] = v;
  return std::tie(x, y, z);
}
template <class Struct>
requires requires(const Struct& s) { fields(s); }
bool same_bits(const Struct& a, const Struct& b);

// Compares all elements of two vectors, arrays or spans.
template <std::ranges::range Range>
bool same_bits(const Range& a, const Range& b) {
  const auto same = [](const auto& x, const auto& y) { return same_bits(x, y); };
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), same);
}

template <class Struct>
requires requires(const Struct& s) { fields(s); }
bool same_bits(const Struct& a, const Struct& b) {
  return std::apply(
      [&](const auto&... of_a) {
        return std::apply([&](const auto&... of_b) { return (same_bits(of_a, of_b) && ...); }, fields(b));
      },
      fields(a));
}

}  // namespace scree
