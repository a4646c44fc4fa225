// Consecutive ranges of global ids, one per rank, for building, reading and writing particles.
#pragma once

#include <algorithm>

#include "base/types.hpp"

namespace scree {

// Ids [first, last).
struct IdRange {
  GlobalId first = 0, last = 0;
  std::int64_t size() const { return last - first; }
};

// The range of one of `ranks` ranks in `count` ids; sizes differ by at most one. Also used for the rows of a
// file.
inline IdRange id_range(std::int64_t count, int rank, int ranks) {
  const std::int64_t each = count / ranks,
                     more = count % ranks;  // avoids the overflow of a product with `rank`
  const auto start = [&](std::int64_t r) { return r * each + std::min(r, more); };
  return {start(rank), start(rank + 1)};
}

// The rank whose range contains an id; the last one for ids above all ranges.
inline int id_owner(std::int64_t count, GlobalId id, int ranks) {
  const std::int64_t each = count / ranks, more = count % ranks, longer = more * (each + 1);
  const std::int64_t rank =
      id < longer ? id / (each + 1) : more + (id - longer) / std::max<std::int64_t>(each, 1);
  return static_cast<int>(std::min<std::int64_t>(rank, ranks - 1));
}

}  // namespace scree
