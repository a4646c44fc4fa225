// Sorting by cell, and the index of ghosts by cell.
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
  // Afterwards order()[k] is the item at place k, items of one key in the order that they had; those of a key
  // stand from starts()[key] to starts()[key + 1], for keys up to last_key.
  void sort(Device device, Index n, unsigned last_key);
  const Index* order() const { return order_.data(); }
  const Index* starts() const { return starts_.data(); }

 private:
  DeviceArray<unsigned> keys_, sorted_keys_;
  DeviceArray<Index> iota_, order_;
  DeviceArray<Index> counts_, starts_;
  DeviceArray<unsigned char> space_;
};

}  // namespace scree
