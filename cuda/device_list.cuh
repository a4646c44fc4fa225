// Neighbour list on the device: the same rows as in src/dem/search/neighbor_list.hpp, laid out for coalesced
// reads.
#pragma once

#include "cell_block_grid.cuh"
#include "dem/contact/contact_walk.hpp"
#include "device_arena.cuh"

namespace scree {

inline constexpr Index kSlice = 32;  // rows per slice: one warp

// Rows in slices of 32: entry k of row i is 32 slots after entry k - 1, next to entry k of row i + 1. A slice
// is as wide as its longest row.
struct SlicedRows {
  const std::int64_t* slice_start;  // [slices]
  const Index* counts;              // [items]
  const Index* neighbors;           // [slots]
  // Number of a row's first entry when the rows are numbered without gaps: indexes the contact history. Null
  // where contacts have no history.
  const Index* first_entry{};  // [items]

  SCREE_HD std::int64_t first(Index i) const { return slice_start[i / kSlice] + i % kSlice; }
  SCREE_HD static constexpr int stride() { return kSlice; }
  SCREE_HD std::int64_t first_number(Index i) const { return first_entry[i]; }
  SCREE_HD Index count(Index i) const { return counts[i]; }

  // As `PackedRows::for_each_contact`, with the number of an entry as its slot.
  template <class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Touches& touches, const Evaluate& evaluate,
                                 const Add& add) const {
    if constexpr (kTakesSlot<Evaluate>) {
      const std::int64_t number = first_entry[i];
      const auto evaluate_at = [&](Index j, std::int64_t entry_index) {
        return evaluate(j, number + entry_index);
      };
      for_each_entry_index(i, touches, evaluate_at, add);
    } else {
      for_each_entry_index(i, touches, evaluate, add);
    }
  }

  // The same, and passes the index of an entry in its row. Tests two entries at once while the next two are
  // loaded: independent loads hide latency.
  template <class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_entry_index(Index i, const Touches& touches, const Evaluate& evaluate,
                                     const Add& add) const {
    const Index* row = neighbors + first(i);
    const Index count = counts[i];
    Index left = count;
    const auto entry = [&](Index k) { return k < left ? row[k * kSlice] : i; };
    Index j[2] = {entry(0), entry(1)};
    while (left > 0) {
      const Index next[2] = {entry(2), entry(3)};
      const bool first_touches = touches(j[0]), second_touches = touches(j[1]) & (left > 1);
      if (first_touches) add(evaluate_entry(evaluate, j[0], count - left));
      if (second_touches) add(evaluate_entry(evaluate, j[1], count - left + 1));
      j[0] = next[0], j[1] = next[1];
      left -= 2, row += 2 * kSlice;
    }
  }

  // The same for launches with few threads, which hide no latency by themselves: `kAtOnce` entries are tested
  // and evaluated at once, whether they touch or not.
  template <int kAtOnce, class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_entry_index_eagerly(Index i, const Touches& touches, const Evaluate& evaluate,
                                             const Add& add) const {
    const Index* row = neighbors + first(i);
    const Index count = counts[i];
    Index left = count;
    Index j[kAtOnce];
    const auto fetch = [&] {
      for (int k = 0; k < kAtOnce; ++k) j[k] = k < left ? row[k * kSlice] : i;
    };
    fetch();
    while (left > 0) {
      bool touching[kAtOnce];
      decltype(evaluate_entry(evaluate, i, 0)) contact[kAtOnce];
      for (int k = 0; k < kAtOnce; ++k) touching[k] = touches(j[k]) & (k < left);
      for (int k = 0; k < kAtOnce; ++k)
        contact[k] = evaluate_entry(evaluate, j[k], count - left + (k < left ? k : 0));
      left -= kAtOnce, row += kAtOnce * kSlice;
      fetch();
      for (int k = 0; k < kAtOnce; ++k)
        if (touching[k]) add(contact[k]);
    }
  }
};

// Which rows an explicit step walks.
enum class RowUse : int {
  pruned,  // pruned rows
  prune,   // all entries, and writes the pruned rows for the next steps
  all      // all entries, because pruned rows would not last with particles this fast
};

// Index of an entry in its row.
using RowIndex = std::uint16_t;

// Rows of an explicit step. Most entries of a list with a skin do not touch. A step that tests all of them
// stores those within a small margin of touching, and the next steps walk only these until a particle has
// moved by half the margin: dynamic pruning, of Pall and Hess, Comput. Phys. Commun. 184 (2013) and J. Chem.
// Phys. 153 (2020). Entries that do not touch add nothing, so that sums have the same bits either way.
// kAtOnce: number of entries that are evaluated at once, touching or not; 0: only touching ones, one by one.
template <int kAtOnce>
struct PrunedRows {
  SlicedRows rows;
  Index *counts, *neighbors;  // the pruned rows, `counts` per item and `neighbors` per slot
  RowUse use;
  Real margin;                // pruning margin [m]
  RowIndex* entry_indices{};  // index of the pruned rows' entries in the whole rows, for the contact history:
                              // [slots]

  // test: as in `PackedRows`, with near(j, margin). Slots are those of the whole rows.
  template <class Test, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Test& test, const Evaluate& evaluate, const Add& add) const {
    if (use == RowUse::prune) return prune(i, test, evaluate, add);
    const bool all = use == RowUse::all;
    const SlicedRows walked{rows.slice_start, all ? rows.counts : counts, all ? rows.neighbors : neighbors};
    if constexpr (kTakesSlot<Evaluate>) {
      const std::int64_t number = rows.first_entry[i], start = rows.first(i);
      const auto evaluate_at = [&](Index j, std::int64_t entry_index) {
        return evaluate(j, number + (all ? entry_index : entry_indices[start + kSlice * entry_index]));
      };
      walk(walked, i, test, evaluate_at, add);
    } else {
      walk(walked, i, test, evaluate, add);
    }
  }

 private:
  template <class Test, class Evaluate, class Add>
  SCREE_HD static void walk(const SlicedRows& walked, Index i, const Test& test, const Evaluate& evaluate,
                            const Add& add) {
    if constexpr (kAtOnce > 0)
      walked.for_each_entry_index_eagerly<kAtOnce>(i, test, evaluate, add);
    else
      walked.for_each_entry_index(i, test, evaluate, add);
  }
  template <class Test, class Evaluate, class Add>
  SCREE_HD void prune(Index i, const Test& test, const Evaluate& evaluate, const Add& add) const {
    const Index* row = rows.neighbors + rows.first(i);
    Index *const pruned_begin = neighbors + rows.first(i), *pruned_end = pruned_begin;
    std::int64_t number = 0;
    if constexpr (kTakesSlot<Evaluate>) number = rows.first_entry[i];
    for (Index left = rows.counts[i]; left > 0; --left, row += kSlice, ++number) {
      const Index j = *row;
      if (test.near(j, margin)) {
        if constexpr (kTakesSlot<Evaluate>)
          entry_indices[pruned_end - neighbors] = static_cast<RowIndex>(rows.counts[i] - left);
        *pruned_end = j, pruned_end += kSlice;
      }
      if (test(j)) add(evaluate_entry(evaluate, j, number));
    }
    counts[i] = static_cast<Index>((pruned_end - pruned_begin) / kSlice);
  }
};

// Items by level and cell: partition/level_grids.hpp on the device.
struct LevelIndex {
  const LevelGrid* levels;  // [count]
  const Index* starts;      // [cells + 1] of all levels, into items
  const Index* items;
  int count = 0;  // 0: one grid for all sizes
};

// Input of the search. Active particles are sorted by cell; ghosts are found through an index of their own.
struct ListInput {
  const Vec4* position;         // all items
  const std::int64_t* row_key;  // sort key of entries per item: global id and image
  CellBlockGrid grid;
  const Index* particle_starts;  // [cells + 1] first active particle of each cell
  const Index* ghost_starts;     // [cells + 1] first of ghost_items of each cell; null without ghosts
  const Index* ghost_items;
  LevelIndex levels;    // with particles of many sizes, in place of the indices above
  Index active, owned;  // number of owned particles, which have rows; rows of inactive ones are empty
  Real skin;            // `NeighborBuilder::search_margin` [m]
};

class DeviceList {
 public:
  // has_history: whether contacts have a history. slots: initial capacity per particle.
  DeviceList(bool has_history, double slots);

  // Queues the search that fills the list. To be followed by complete(), once the stream has been waited for,
  // which repeats the search with more memory if that did not suffice. They throw `DeviceError` where there
  // is too little memory, and `SimulationError` where contacts have a history and a row is too long for
  // `RowIndex` or there are more entries than an `Index` can count.
  void search(Device device, const ListInput& in);
  void complete(Device device, const ListInput& in);

  SlicedRows rows() const {
    return {slice_start_.data(), counts_.data(), neighbors_.data(), first_entry_.data()};
  }
  // Scratch memory for n values while the list is not needed.
  Index* scratch_space(std::size_t n);
  // Arrays of pruned rows besides those of the list. After a build they are undefined until a step with
  // `RowUse::prune`.
  ArenaArray<Index> reserve_pruned() { return {pruned_, neighbors_.size()}; }
  ArenaArray<RowIndex> reserve_row_indices() {
    return {entry_indices_, has_history_ ? neighbors_.size() : 0};
  }
  PrunedRows<0> pruned_rows();
  std::int64_t slots() const { return static_cast<std::int64_t>(neighbors_.size()); }
  std::size_t bytes() const {
    return slice_start_.bytes() + counts_.bytes() + first_entry_.bytes() + neighbors_.bytes() +
           pruned_counts_.bytes();
  }
  std::int64_t entries() const { return h_totals_[0].entries; }

 private:
  struct Totals {
    unsigned long long used;     // slots
    unsigned long long entries;  // number of entries
    Index longest;               // row
  };
  void queue(Device device, const ListInput& in);

  const bool has_history_;
  const double slots_at_start_;  // initial slots per particle
  DeviceArray<std::int64_t> slice_start_;
  DeviceArray<Index> counts_, first_entry_, neighbors_, pruned_counts_, pruned_;
  DeviceArray<RowIndex> entry_indices_;
  DeviceArray<Totals> totals_;
  PinnedArray<Totals> h_totals_;
  friend struct RowOutputs;
};

}  // namespace scree
