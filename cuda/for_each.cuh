// The loop over items as a kernel launch, the counterpart of base/for_each.hpp, and maxima over items.
#pragma once

#include <cuda/atomic>
#include <type_traits>

#include "base/types.hpp"
#include "device.cuh"
#include "launches.hpp"

namespace scree {

inline unsigned blocks_for(std::int64_t n, int threads = launches().block) {
  return static_cast<unsigned>((n + threads - 1) / threads);
}

__device__ inline Index thread_index() { return static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x); }

template <class Item>
__global__ void for_each_kernel(Index n, const Item item) {
  const Index i = thread_index();
  if (i < n) item(i);
}

// Calls item(i) for i = 0 ... n-1, in any order. The item's pointers are the device's.
// Throws DeviceError if the launch fails.
template <class Item>
void for_each(Device device, Index n, const Item& item) {
  static_assert(std::is_trivially_copyable_v<Item>, "an item is copied to the device as bytes");
  if (n <= 0) return;
  for_each_kernel<<<blocks_for(n), launches().block, 0, device.stream>>>(n, item);
  require_cuda(cudaGetLastError(), "for_each");
}

// Non-negative doubles are ordered like their bits, and a NaN's bits exceed them all: the largest bits are
// the largest number, or a NaN if there is one, in any order of the threads.
__device__ inline unsigned long long ordered_bits(Real value) {
  return value <= 0 ? 0 : static_cast<unsigned long long>(__double_as_longlong(value)) & ~(1ull << 63);
}

// Every thread of the block calls this; *d_largest becomes the largest value.
__device__ inline void block_max(Real value, Real* d_largest) {
  __shared__ unsigned long long largest;
  if (threadIdx.x == 0) largest = 0;
  __syncthreads();
  unsigned long long bits = ordered_bits(value);
  for (int offset = warpSize / 2; offset > 0; offset /= 2) {
    const unsigned long long other = __shfl_down_sync(~0u, bits, offset);
    bits = other > bits ? other : bits;
  }
  if (threadIdx.x % warpSize == 0 && bits > 0) atomicMax(&largest, bits);
  __syncthreads();
  auto* target = reinterpret_cast<unsigned long long*>(d_largest);
  // A plain read avoids most of the atomics: the value only grows.
  if (threadIdx.x == 0 && largest > *reinterpret_cast<volatile unsigned long long*>(target))
    atomicMax(target, largest);
  __syncthreads();
}

// Called by one thread per block after the block's share of a result: true for the last block of the grid,
// whose calling thread then sees everything the others wrote. *finished is 0 again afterwards.
__device__ inline bool is_last_block(unsigned* finished, unsigned blocks) {
  // A release suffices here: an acquire in every block would invalidate the L1 cache of its multiprocessor
  // each time.
  const cuda::atomic_ref<unsigned, cuda::thread_scope_device> count(*finished);
  if (count.fetch_add(1, cuda::memory_order_release) != blocks - 1) return false;
  cuda::atomic_thread_fence(cuda::memory_order_acquire, cuda::thread_scope_device);
  *finished = 0;
  return true;
}

template <class Item>
__global__ void max_over_kernel(Index n, const Item item, Real* d_largest) {
  const Index i = thread_index();
  block_max(i < n ? item(i) : 0, d_largest);
}

// The largest item(i), at least 0; a NaN makes the result a NaN. It stays on the device, in *d_largest:
// reading it here would wait for the stream.
template <class Item>
void max_over(Device device, Index n, const Item& item, Real* d_largest) {
  static_assert(std::is_trivially_copyable_v<Item>, "an item is copied to the device as bytes");
  static_assert(sizeof(Real) == sizeof(unsigned long long));
  require_cuda(cudaMemsetAsync(d_largest, 0, sizeof(Real), device.stream), "max_over");
  if (n <= 0) return;
  max_over_kernel<<<blocks_for(n), launches().block, 0, device.stream>>>(n, item, d_largest);
  require_cuda(cudaGetLastError(), "max_over");
}

}  // namespace scree
