// Consecutive ranges of global ids, one per rank: who builds, reads and writes which particles.
#pragma once

#include <algorithm>

#include "base/types.hpp"

namespace scree {

// Ids [first, last).
struct IdRange {
  GlobalId first = 0, last = 0;
  std::int64_t size() const { return last - first; }
};

// Share of one of `ranks` ranks in `count` ids, in equal parts but for one id. The same for the rows of a
// file.
inline IdRange id_range(std::int64_t count, int rank, int ranks) {
  const std::int64_t each = count / ranks,
                     more = count % ranks;  // the product with `rank` could be too large
  const auto start = [&](std::int64_t r) { return r * each + std::min(r, more); };
  return {start(rank), start(rank + 1)};
}

// The rank whose share an id is in.
inline int id_owner(std::int64_t count, GlobalId id, int ranks) {
  const std::int64_t each = count / ranks, more = count % ranks, longer = more * (each + 1);
  return static_cast<int>(id < longer ? id / (each + 1)
                                      : more + (id - longer) / std::max<std::int64_t>(each, 1));
}

}  // namespace scree
