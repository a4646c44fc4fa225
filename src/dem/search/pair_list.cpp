#include "dem/search/pair_list.hpp"

#include <algorithm>

namespace scree {
namespace {

// Slot of an item in a row, which is ordered by key.
Index slot_in_row(const NeighborList& list, const ParticleStore& store, Index row, Index item) {
  const auto begin = list.neighbors.begin();
  const auto at =
      std::lower_bound(begin + list.offsets[row], begin + list.offsets[row + 1], store.row_key[item],
                       [&](Index j, std::int64_t key) { return store.row_key[j] < key; });
  return static_cast<Index>(at - begin);
}

}  // namespace

void PairList::match(const NeighborList& list, const ParticleStore& store) {
  offsets.assign(1, 0), pairs.clear();
  for (Index i = 0; i < store.owned; ++i) {
    for (Index slot = list.offsets[i]; slot < list.offsets[i + 1]; ++slot) {
      const Index j = list.neighbors[slot];
      if (j >= store.owned)
        pairs.push_back({j, slot, ListedPair::kNone});
      else if (i < j)
        pairs.push_back({j, slot, slot_in_row(list, store, j, i)});
    }
    offsets.push_back(static_cast<Index>(pairs.size()));
  }
  slots = list.neighbors.size(), is_current = true;
  has_records = false;
}

void PairList::fetch_records(const Vec4* at_slots, Index count) {
  const auto n = static_cast<std::size_t>(count);
  records.resize(pairs.size() * n);
  for (std::size_t p = 0; p < pairs.size(); ++p)
    std::copy_n(at_slots + static_cast<std::size_t>(pairs[p].slot) * n, n, records.data() + p * n);
  has_records = true;
}

}  // namespace scree
