// Conversions of indices and counts between signed types and std::size_t. Builds without NDEBUG check them.
#pragma once

#include <cassert>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// A non-negative integer as std::size_t: the index of an element of a vector, or a number of elements.
template <class Integer>
SCREE_HD constexpr std::size_t as_size(Integer i) {
  static_assert(std::is_integral_v<Integer>);
  if constexpr (std::is_signed_v<Integer>) assert(i >= 0);
  return static_cast<std::size_t>(i);
}

// An index or a number of elements as an Index, where it is known to fit (otherwise countable()).
template <class Integer>
SCREE_HD constexpr Index as_index(Integer i) {
  static_assert(std::is_integral_v<Integer>);
  assert(static_cast<long long>(i) <= std::numeric_limits<Index>::max());
  return static_cast<Index>(i);
}

}  // namespace scree
