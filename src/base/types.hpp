// Scalar types of the whole code.
#pragma once

#include <cstdint>
#include <limits>

namespace scree {

using Real = double;
using Index = std::int32_t;     // local index of an item on one rank
using GlobalId = std::int64_t;  // identity that survives sorting and migration

inline constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

}  // namespace scree
