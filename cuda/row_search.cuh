// Search of a row for touching entries, where the contacts of several rows are evaluated together.
#pragma once

#include "device_list.cuh"

namespace scree {

// Test: as in `PrunedRows`; a test without near() is for whole rows. A step that walks whole rows also stores
// the pruned ones.
template <class Test>
class RowSearch {
 public:
  // idle: there is no row.
  __device__ RowSearch(const PrunedRows<0>& rows, Index i, bool idle)
      : rows_(rows), i_(i), use_(kPrunes ? rows.use : RowUse::all) {
    start_ = rows.rows.slice_start[i / kSlice] + i % kSlice;
    row_ = (is_whole() ? rows.rows.neighbors : rows.neighbors) + start_;
    count_ = idle ? 0 : (is_whole() ? rows.rows.counts : rows.counts)[i];
  }

  // Calls add(k, j, entry_index) for the next touching entries in the order of the row, at most `capacity` of
  // them: k counts them, entry_index is the index of the entry in the whole row. Returns their number.
  template <class Add>
  __device__ Index find(const Test& test, Index capacity, const Add& add) {
    Index found = 0;
    Entries at = entries(next_);
    for (; next_ < count_; next_ += kAtOnce) {
      const Entries ahead = entries(next_ + kAtOnce);
      bool touches[kAtOnce];
      Index touching = found;
      for (Index k = 0; k < kAtOnce; ++k)
        touches[k] = test(at.j[k]) & (next_ + k < count_), touching += touches[k];
      if (touching > capacity) break;
      if constexpr (kPrunes)
        if (use_ == RowUse::prune)
          for (Index k = 0; k < kAtOnce && next_ + k < count_; ++k)
            if (test.near(at.j[k], rows_.margin)) store_pruned(at.j[k], next_ + k);
      for (Index k = 0; k < kAtOnce; ++k)
        if (touches[k]) add(found++, at.j[k], at.entry_index[k]);
      at = ahead;
    }
    return found;
  }
  __device__ bool done() const { return next_ >= count_; }
  // To be called at the end.
  __device__ void store_count(bool idle) const {
    if (use_ == RowUse::prune && !idle) rows_.counts[i_] = pruned_count_;
  }

 private:
  static constexpr bool kPrunes = requires(const Test& test) { test.near(Index{}, Real{}); };
  // A few entries at once while the next are loaded: independent loads hide latency.
  static constexpr Index kAtOnce = 4;
  struct Entries {
    Index j[kAtOnce];
    RowIndex entry_index[kAtOnce];
  };

  __device__ bool is_whole() const { return use_ != RowUse::pruned; }
  __device__ Entries entries(Index first) const {
    Entries at;
    for (Index k = 0; k < kAtOnce; ++k) {
      const bool is_entry = first + k < count_;
      at.j[k] = is_entry ? row_[(first + k) * kSlice] : i_;
      at.entry_index[k] = is_whole() || !is_entry ? static_cast<RowIndex>(first + k)
                                                  : rows_.entry_indices[start_ + (first + k) * kSlice];
    }
    return at;
  }
  __device__ void store_pruned(Index j, Index row_index) {
    const std::int64_t slot = start_ + pruned_count_++ * kSlice;
    rows_.entry_indices[slot] = static_cast<RowIndex>(row_index), rows_.neighbors[slot] = j;
  }

  const PrunedRows<0>& rows_;
  Index i_;
  RowUse use_;
  std::int64_t start_;
  const Index* row_;
  Index count_, next_ = 0, pruned_count_ = 0;
};

}  // namespace scree
