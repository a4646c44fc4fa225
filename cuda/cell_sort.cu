#include "cell_sort.cuh"

#include <bit>
#include <cub/device/device_radix_sort.cuh>

#include "for_each.cuh"

namespace scree {
namespace {

struct IotaItem {
  Index* out;
  SCREE_HD void operator()(Index i) const { out[i] = i; }
};

// Where the keys change in sorted order, a cell ends and another begins.
struct RangeItem {
  const unsigned* keys;
  CellRange* ranges;
  Index n;
  SCREE_HD void operator()(Index i) const {
    const unsigned key = keys[i];
    if (i == 0 || keys[i - 1] != key) ranges[key].begin = i;
    if (i == n - 1 || keys[i + 1] != key) ranges[key].end = i + 1;
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
  sorted_keys_.resize(size), order_.resize(size), ranges_.resize(static_cast<std::size_t>(last_key) + 1);
  ranges_.zero(device.stream);
  if (n == 0) return;
  const int bits = std::max(1, static_cast<int>(std::bit_width(last_key)));
  std::size_t space = 0;
  const auto sort = [&](void* at) {
    require_cuda(cub::DeviceRadixSort::SortPairs(at, space, keys_.data(), sorted_keys_.data(), iota_.data(),
                                                 order_.data(), n, 0, bits, device.stream),
                 "sort");
  };
  sort(nullptr);
  space_.resize(space);
  sort(space_.data());
  for_each(device, n, RangeItem{sorted_keys_.data(), ranges_.data(), n});
}

}  // namespace scree
