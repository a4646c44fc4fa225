// Sorting of items by cell, and the index of ghosts by cell.
#pragma once

#include "cell_block_grid.cuh"
#include "device.cuh"
#include "device_list.cuh"

namespace scree {

// Sorts n items by keys 0 ... last_key. The workspace keeps its memory from one sort to the next.
class CellSort {
 public:
  // Scratch values of type `Index` per item.
  static constexpr std::size_t kNumbers = 4;
  // From now on the sort of n items uses this scratch memory, which must stay valid as long as keys and order
  // are needed.
  void use_scratch(Index* scratch, std::size_t n);
  // Keys of the items to sort; written by the caller before sort().
  unsigned* keys(std::size_t n);
  // Afterwards order()[k] is the item at position k; the sort is stable. Items of one key are at
  // starts()[key] ... starts()[key + 1] - 1, for keys up to last_key.
  void sort(Device device, Index n, unsigned last_key);
  const Index* order() const { return sorted_; }
  const Index* starts() const { return starts_.data(); }

 private:
  DeviceArray<unsigned> keys_[2];  // double buffer of the radix sort
  DeviceArray<Index> order_[2];
  const Index* sorted_ = nullptr;
  DeviceArray<Index> starts_;
  DeviceArray<unsigned char> space_;
};

}  // namespace scree
