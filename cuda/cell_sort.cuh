// Sorting by cell, and the index of ghosts and shapes by cell.
#pragma once

#include "brick_grid.cuh"
#include "device.cuh"
#include "device_list.cuh"

namespace scree {

// Sorts n items by keys 0 ... last_key. Workspace that keeps its memory from one sort to the next.
class CellSort {
 public:
  // Keys of the items to sort; written by the caller before sort().
  unsigned* keys(std::size_t n);
  // Afterwards order()[k] is the item at place k, items of one key in the order that they had; ranges()[key] is where
  // the items of that key stand. Keys up to last_key have ranges.
  void sort(Device device, Index n, unsigned last_key);
  const Index* order() const { return order_.data(); }
  const CellRange* ranges() const { return ranges_.data(); }

 private:
  DeviceArray<unsigned> keys_, sorted_keys_;
  DeviceArray<Index> iota_, order_;
  DeviceArray<CellRange> ranges_;
  DeviceArray<unsigned char> space_;
};

}  // namespace scree
