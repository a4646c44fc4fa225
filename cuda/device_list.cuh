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

  // As PackedRows::for_each_contact. Two entries are tested at once while the next two are under way: loads that do not
  // wait for each other.
  template <class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Touches& touches, const Evaluate& evaluate, const Add& add) const {
    const Index* row = neighbors + first(i);
    Index left = counts[i];
    const auto entry = [&](Index k) { return k < left ? row[k * kSlice] : i; };
    Index j[2] = {entry(0), entry(1)};
    while (left > 0) {
      const Index next[2] = {entry(2), entry(3)};
      const bool first_touches = touches(j[0]), second_touches = touches(j[1]) & (left > 1);
      if (first_touches) add(evaluate(j[0]));
      if (second_touches) add(evaluate(j[1]));
      j[0] = next[0], j[1] = next[1];
      left -= 2, row += 2 * kSlice;
    }
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

// What the search reads. Active particles stand in the order of their cells; ghosts and shapes are found through an
// index of their own.
struct ListInput {
  const Vec4* position;         // all items
  const std::int64_t* row_key;  // all items: orders the entries of a row, by global id and image
  BrickGrid grid;
  const Index* particle_starts;  // [cells + 1] into the active particles
  const Index* other_starts;     // [cells + 1] into other_items: ghosts and shapes; null without any
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
