// Sequences of items of several kinds in which each kind keeps as close to its share as possible.
#pragma once

#include <cstdint>
#include <span>

#include "base/types.hpp"

namespace scree {

// The kind of the next item by Tijdeman's chairman assignment (Discrete Mathematics 32, 1980): with k kinds,
// after any number n of items, the number of each kind differs from its share times n by at most
// 1 - 1 / (2 k - 2). shares: > 0, with sum 1. counts: items of each kind so far, as this function chose them.
// u: in [0, 1), chooses among kinds that are equally urgent.
int next_by_shares(std::span<const Real> shares, std::span<const std::int64_t> counts, Real u);

}  // namespace scree
