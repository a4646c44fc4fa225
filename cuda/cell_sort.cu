#include <bit>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "cell_sort.cuh"
#include "for_each.cuh"

namespace scree {
namespace {

struct IotaItem {
  Index* out;
  SCREE_HD void operator()(Index i) const { out[i] = i; }
};

// Where the keys change in sorted order, a cell ends and another begins: the difference of the two is its
// count.
struct CountItem {
  const unsigned* keys;
  Index* counts;
  Index n;
  __device__ void operator()(Index i) const {
    const unsigned key = keys[i];
    if (i == 0 || keys[i - 1] != key) atomicSub(&counts[key], i);
    if (i == n - 1 || keys[i + 1] != key) atomicAdd(&counts[key], i + 1);
  }
};

}  // namespace

unsigned* CellSort::keys(std::size_t n) {
  keys_.resize(n);
  return keys_.data();
}

void CellSort::sort(Device device, Index n, unsigned last_key) {
  const auto size = static_cast<std::size_t>(n);
  if (iota_.size() < size) {
    iota_.resize(size);
    for_each(device, n, IotaItem{iota_.data()});
  }
  const std::size_t starts = static_cast<std::size_t>(last_key) + 2;
  sorted_keys_.resize(size), order_.resize(size), counts_.resize(starts), starts_.resize(starts);
  counts_.zero(device.stream);
  const int key_bits = std::max(1, static_cast<int>(std::bit_width(last_key)));
  const auto sort = [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceRadixSort::SortPairs(at, bytes, keys_.data(), sorted_keys_.data(), iota_.data(),
                                                 order_.data(), n, 0, key_bits, device.stream),
                 "sort");
  };
  if (n > 0) with_space(space_, sort);
  for_each(device, n, CountItem{sorted_keys_.data(), counts_.data(), n});
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(
        cub::DeviceScan::ExclusiveSum(at, bytes, counts_.data(), starts_.data(), starts, device.stream),
        "scan");
  });
}

}  // namespace scree
