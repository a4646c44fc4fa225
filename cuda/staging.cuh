// A warp's stretch of an array in shared memory, so that device memory is read and written in whole sectors.
#pragma once

#include <cstddef>

#include "base/types.hpp"

namespace scree {

// Copies n values between device and shared memory, the lanes of the warp side by side in units of 8 bytes.
template <class T>
__device__ void copy_by_warp(T* to, const T* from, Index n) {
  static_assert(sizeof(T) % sizeof(double) == 0);
  constexpr Index kUnits = sizeof(T) / sizeof(double);
  const Index lane = static_cast<Index>(threadIdx.x) % warpSize;
#pragma unroll
  for (Index u = 0; u < kUnits; ++u) {
    const Index unit = u * warpSize + lane;
    if (unit < n * kUnits) reinterpret_cast<double*>(to)[unit] = reinterpret_cast<const double*>(from)[unit];
  }
}

// The stretch of a block's warp. at(first) is a pointer through which the elements first ... first + 31 of the array
// are reached: an item that reads and writes only its own element may use it in place of the array.
template <class T, int kThreads>
class WarpStage {
 public:
  struct Shared {
    alignas(16) unsigned char bytes[kThreads * sizeof(T)];
  };
  __device__ explicit WarpStage(Shared& shared)
      : values_(reinterpret_cast<T*>(shared.bytes) + threadIdx.x / warpSize * warpSize) {}
  __device__ T* at(Index first) const { return values_ - first; }
  __device__ void load(const T* array, Index first, Index n) const { copy_by_warp(values_, array + first, n); }
  __device__ void store(T* array, Index first, Index n) const { copy_by_warp(array + first, values_, n); }

 private:
  T* values_;
};

}  // namespace scree
