// Sums over items that do not depend on the order of the additions: base/reproducible_sum.hpp on the device,
// with the same bits.
#pragma once

#include "base/reproducible_sum.hpp"
#include "for_each.cuh"

namespace scree {

// Workspace of N sums. Quanta are added as two halves of 32 bits, because the device has atomic additions of
// 64 bits only: up to 2^31 terms of 62 bits do not overflow.
template <int N>
struct ExactSums {
  Real largest[N];
  unsigned long long high[N], low[N];

  __int128 quanta(int k) const {
    return static_cast<__int128>(static_cast<long long>(high[k])) * (1ll << 32) +
           static_cast<__int128>(low[k]);
  }
};

template <int N, class Item>
__global__ void largest_terms_kernel(Index n, const Item item, ExactSums<N>* sums) {
  const Index i = thread_index();
  decltype(item(0)) terms{};
  if (i < n) terms = item(i);
  for (int k = 0; k < N; ++k) block_max(std::abs(terms.value[k]), &sums->largest[k]);
}

__device__ inline unsigned long long warp_sum(unsigned long long value) {
  for (int offset = warpSize / 2; offset > 0; offset /= 2) value += __shfl_down_sync(~0u, value, offset);
  return value;
}

template <int N, class Item>
__global__ void add_terms_kernel(Index n, const Item item, ExactSums<N>* sums) {
  __shared__ unsigned long long high[N], low[N];
  if (threadIdx.x < N) high[threadIdx.x] = low[threadIdx.x] = 0;
  __syncthreads();
  const Index i = thread_index();
  decltype(item(0)) terms{};
  if (i < n) terms = item(i);
  for (int k = 0; k < N; ++k) {
    const std::int64_t quanta = ReproducibleScale(sums->largest[k]).quanta(terms.value[k]);
    const unsigned long long h = warp_sum(static_cast<unsigned long long>(quanta >> 32)),
                             l = warp_sum(static_cast<unsigned long long>(quanta) & 0xffffffffull);
    if (threadIdx.x % warpSize == 0) atomicAdd(&high[k], h), atomicAdd(&low[k], l);
  }
  __syncthreads();
  if (threadIdx.x < N)
    atomicAdd(&sums->high[threadIdx.x], high[threadIdx.x]),
        atomicAdd(&sums->low[threadIdx.x], low[threadIdx.x]);
}

// Queues the sums of item(i).value[0 ... N-1] over i = 0 ... n-1 into *d_sums. share(largest) is called
// between the two passes to reduce the largest terms over the ranks.
template <int N, class Item, class Share>
void exact_sums(Device device, Index n, const Item& item, ExactSums<N>* d_sums, const Share& share) {
  require_cuda(cudaMemsetAsync(d_sums, 0, sizeof(ExactSums<N>), device.stream), "exact_sums");
  if (n > 0) largest_terms_kernel<N><<<blocks_for(n), launches().block, 0, device.stream>>>(n, item, d_sums);
  share(d_sums->largest);
  if (n > 0) add_terms_kernel<N><<<blocks_for(n), launches().block, 0, device.stream>>>(n, item, d_sums);
  require_cuda(cudaGetLastError(), "exact_sums");
}

}  // namespace scree
