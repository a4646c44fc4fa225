// The loop over items as a kernel launch: the namesake of base/for_each.hpp.
#pragma once

#include <type_traits>

#include "base/types.hpp"
#include "device.cuh"

namespace scree {

inline constexpr int kThreadsPerBlock = 128;

template <class Item>
__global__ void for_each_kernel(Index n, const Item item) {
  const Index i = static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < n) item(i);
}

// Non-negative doubles are ordered like their bits, and a NaN's bits lie above all of them: the largest bits are
// the largest number, or a NaN if there is one, in whatever order the threads come.
template <class Item>
__global__ void max_over_kernel(Index n, const Item item, Real* d_largest) {
  const Index i = static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x);
  unsigned long long largest = 0;
  if (i < n) {
    const Real value = item(i);
    if (!(value <= 0)) largest = static_cast<unsigned long long>(__double_as_longlong(value));
  }
  for (int offset = warpSize / 2; offset > 0; offset /= 2) {
    const unsigned long long other = __shfl_down_sync(~0u, largest, offset);
    largest = other > largest ? other : largest;
  }
  if (threadIdx.x % warpSize == 0 && largest > 0)
    atomicMax(reinterpret_cast<unsigned long long*>(d_largest), largest);
}

inline unsigned blocks_for(Index n) {
  return (static_cast<unsigned>(n) + kThreadsPerBlock - 1) / kThreadsPerBlock;
}

// Calls item(i) for i = 0 ... n-1, in any order. The item's pointers are the device's.
// Throws SimulationError if the launch fails.
template <class Item>
void for_each(Device device, Index n, const Item& item) {
  static_assert(std::is_trivially_copyable_v<Item>, "an item travels to the device as bytes");
  if (n <= 0) return;
  for_each_kernel<<<blocks_for(n), kThreadsPerBlock, 0, device.stream>>>(n, item);
  require_cuda(cudaGetLastError(), "for_each");
}

// The same for items that return a number: the largest of them, at least 0; a NaN makes the result a NaN. It stays on
// the device, in *d_largest, because reading it here would wait for the stream.
template <class Item>
void max_over(Device device, Index n, const Item& item, Real* d_largest) {
  static_assert(std::is_trivially_copyable_v<Item>, "an item travels to the device as bytes");
  static_assert(sizeof(Real) == sizeof(unsigned long long));
  require_cuda(cudaMemsetAsync(d_largest, 0, sizeof(Real), device.stream), "max_over");
  if (n <= 0) return;
  max_over_kernel<<<blocks_for(n), kThreadsPerBlock, 0, device.stream>>>(n, item, d_largest);
  require_cuda(cudaGetLastError(), "max_over");
}

}  // namespace scree
