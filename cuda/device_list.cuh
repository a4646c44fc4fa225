// Neighbour list on the device: the same rows as those of src/dem/neighbor_list.hpp, laid out for coalesced reads.
#pragma once

#include "brick_grid.cuh"
#include "dem/contact_items.hpp"
#include "device.cuh"

namespace scree {

inline constexpr Index kSlice = 32;  // rows that share a slice: one warp

// Rows in slices of 32: entry k of row i stands 32 slots after entry k - 1, beside entry k of row i + 1. A slice is as
// wide as its longest row.
struct SlicedRows {
  const std::int64_t* slice_start;  // [slices]
  const Index* counts;              // [items]
  const Index* neighbors;           // [slots]

  SCREE_HD std::int64_t first(Index i) const { return slice_start[i / kSlice] + i % kSlice; }
  SCREE_HD static constexpr int stride() { return kSlice; }

  // As PackedRows::for_each_contact. First the entries that touch are marked, with several loads in flight; then they
  // are evaluated kAtOnce at a time: few lanes of a warp then wait for others, and latencies overlap.
  template <int kAtOnce, class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Touches& touches, const Evaluate& evaluate, const Add& add) const {
    constexpr Index kMarks = 32;
    const Index* row = neighbors + first(i);
    const auto entry = [&](Index k) { return row[k * kSlice]; };
    for (Index left = counts[i]; left > 0; left -= kMarks, row += kMarks * kSlice) {
      unsigned marks = find_touching(row, left < kMarks ? left : kMarks, i, touches);
      while (marks != 0) {
        const Index j = entry(lowest(marks));
        marks &= marks - 1;
        if constexpr (kAtOnce == 1) {
          add(evaluate(j));
        } else {
          const bool two = marks != 0;
          const Index j2 = two ? entry(lowest(marks)) : j;
          marks &= marks - 1;  // 0 stays 0
          const auto one = evaluate(j), other = evaluate(j2);
          add(one);
          if (two) add(other);
        }
      }
    }
  }

 private:
  // Bit k for the k-th of n entries if it touches.
  template <class Touches>
  SCREE_HD static unsigned find_touching(const Index* row, Index n, Index i, const Touches& touches) {
    constexpr int kInFlight = 4;
    unsigned marks = 0;
    for (Index k = 0; k < n; k += kInFlight) {
      Index j[kInFlight];
#pragma unroll
      for (int e = 0; e < kInFlight; ++e) j[e] = k + e < n ? row[(k + e) * kSlice] : i;
#pragma unroll
      for (int e = 0; e < kInFlight; ++e)
        if (touches(j[e]) && k + e < n) marks |= 1u << (k + e);
    }
    return marks;
  }
  SCREE_HD static Index lowest(unsigned marks) {
#ifdef __CUDA_ARCH__
    return __ffs(static_cast<int>(marks)) - 1;
#else
    return __builtin_ctz(marks);
#endif
  }
};

// Which bodies' shapes may touch: BodyShapes::may_touch for the device.
struct ShapeBodies {
  const Index* body;                         // [shape items]
  const Index *connected_offsets, *connected;  // bodies that body b must not touch besides itself

  SCREE_HD bool may_touch(Index a, Index b) const {
    if (body[a] == body[b]) return false;
    for (Index k = connected_offsets[body[a]]; k < connected_offsets[body[a] + 1]; ++k)
      if (connected[k] == body[b]) return false;
    return true;
  }
};

// The items of one cell: [begin, end).
struct CellRange {
  Index begin, end;
};

// What the search reads. Active particles stand in the order of their cells; ghosts and shapes are found through an
// index of their own.
struct ListInput {
  const Vec4* position;         // all items
  const std::int64_t* row_key;  // all items: orders the entries of a row, by global id and image
  BrickGrid grid;
  const CellRange* cell_particles;  // [cells] of active particles
  const CellRange* cell_others;     // [cells] of other_items: ghosts and shapes; null without any
  const Index* other_items;
  ShapeBodies bodies;
  const WallPlane* planes;
  Index walls;
  Index active, owned, first_shape, first_image, items;  // first_image: of the shapes' images
  Real skin;                                              // [m]
};

class DeviceList {
 public:
  DeviceList();

  // Fills the list. Waits for the device once, to know whether the memory sufficed, and repeats with more if not.
  // Throws DeviceError where there is none.
  void build(Device device, const ListInput& in);

  SlicedRows rows() const { return {slice_start_.data(), counts_.data(), neighbors_.data()}; }
  const Index* wall_offsets() const { return wall_offsets_.data(); }
  const Index* walls() const { return walls_.data(); }
  std::int64_t slots() const { return static_cast<std::int64_t>(neighbors_.size()); }
  std::int64_t entries() const { return h_totals_[0].entries; }

 private:
  struct Totals {
    unsigned long long used;     // slots
    unsigned long long entries;  // of them filled
    Index longest;               // row
    Index wall_entries;
  };
  void search(Device device, const ListInput& in);

  DeviceArray<std::int64_t> slice_start_;
  DeviceArray<Index> counts_, neighbors_, wall_counts_, wall_offsets_, walls_;
  DeviceArray<unsigned char> scan_space_;
  DeviceArray<Totals> totals_;
  PinnedArray<Totals> h_totals_;
  friend struct RowOutputs;
};

}  // namespace scree
