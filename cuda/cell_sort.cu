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

// A cell starts where the key changes in sorted order; the difference of two starts is its number of items.
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

void CellSort::use_scratch(Index* scratch, std::size_t n) {
  for (std::size_t k = 0; k < 2; ++k)
    keys_[k].alias_memory(reinterpret_cast<unsigned*>(scratch + k * n), n),
        order_[k].alias_memory(scratch + (2 + k) * n, n);
}

unsigned* CellSort::keys(std::size_t n) {
  for (int k = 0; k < 2; ++k) keys_[k].resize_with_spare(n), order_[k].resize_with_spare(n);
  return keys_[0].data();
}

void CellSort::sort(Device device, Index n, unsigned last_key) {
  const std::size_t starts = static_cast<std::size_t>(last_key) + 2;
  starts_.resize_with_spare(starts);
  starts_.zero(device.stream);
  for_each(device, n, IotaItem{order_[0].data()});
  cub::DoubleBuffer<unsigned> keys(keys_[0].data(), keys_[1].data());
  cub::DoubleBuffer<Index> order(order_[0].data(), order_[1].data());
  const int key_bits = std::max(1, static_cast<int>(std::bit_width(last_key)));
  const auto sort = [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceRadixSort::SortPairs(at, bytes, keys, order, n, 0, key_bits, device.stream),
                 "sort");
  };
  if (n > 0) with_space(space_, sort);
  sorted_ = order.Current();
  for_each(device, n, CountItem{keys.Current(), starts_.data(), n});
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceScan::ExclusiveSum(at, bytes, starts_.data(), starts, device.stream), "scan");
  });
}

}  // namespace scree
