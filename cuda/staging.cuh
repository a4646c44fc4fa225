// Staging of a warp's part of an array through shared memory: device memory is read and written in whole
// sectors.
#pragma once

#include <cuda_pipeline.h>

#include <cstddef>

#include "base/types.hpp"

namespace scree {

// Staging memory of the warps of a block. kBytes: size of the largest element. One array at a time, because
// shared memory is taken from the L1 cache. All lanes of a warp call load, store and put together.
template <std::size_t kBytes, int kThreads>
class WarpStage {
 public:
  struct Shared {
    alignas(16) unsigned char bytes[kThreads * kBytes];
  };
  // The warp's elements are first ... first + n - 1.
  __device__ WarpStage(Shared& shared, Index first, Index n)
      : WarpStage(shared.bytes + threadIdx.x / warpSize * warpSize * kBytes, first, n) {}
  // `shared`: kBytes per lane for this warp alone.
  __device__ WarpStage(unsigned char* memory, Index first, Index n) : bytes_(memory), first_(first), n_(n) {}

  // Starts to load the warp's elements of the array, and returns a pointer that replaces the array: an item
  // that accesses only its own element may use it between await and store.
  template <class T>
  __device__ T* load(const T* array) const {
    const auto* from = reinterpret_cast<const double*>(array + first_);
    auto* to = reinterpret_cast<double*>(bytes_);
    for (Index unit = lane(); unit < n_ * kUnits<T>; unit += warpSize)
      __pipeline_memcpy_async(to + unit, from + unit, sizeof(double));
    __pipeline_commit();
    return values_of<T>() - first_;
  }
  __device__ void await() const {
    __pipeline_wait_prior(0);
    __syncwarp();
  }
  // Writes the elements back.
  template <class T>
  __device__ void store(T* array) const {
    __syncwarp();
    const auto* from = reinterpret_cast<const double*>(bytes_);
    auto* to = reinterpret_cast<double*>(array + first_);
#pragma unroll
    for (Index u = 0; u < kUnits<T>; ++u)
      if (const Index unit = u * warpSize + lane(); unit < n_ * kUnits<T>) to[unit] = from[unit];
    __syncwarp();
  }
  // Writes each lane's value to its element of the array.
  template <class T>
  __device__ void put(const T& value, T* array) const {
    values_of<T>()[lane()] = value;
    store(array);
  }

 private:
  template <class T>
  static constexpr Index kUnits = sizeof(T) / sizeof(double);  // units that the lanes copy side by side

  __device__ static Index lane() { return static_cast<Index>(threadIdx.x % warpSize); }
  template <class T>
  __device__ T* values_of() const {
    static_assert(sizeof(T) <= kBytes && sizeof(T) % sizeof(double) == 0);
    return reinterpret_cast<T*>(bytes_);
  }
  unsigned char* bytes_;
  Index first_, n_;
};

// One record per lane, for items that write theirs to arbitrary elements of an array: the warp copies each of
// them with coalesced writes.
template <class T, int kThreads>
class WarpRecords {
 public:
  struct Shared {
    alignas(16) unsigned char bytes[kThreads * sizeof(T)];
  };
  __device__ explicit WarpRecords(Shared& shared)
      : records_(reinterpret_cast<T*>(shared.bytes) + threadIdx.x / warpSize * warpSize) {}

  __device__ T& own() const { return records_[lane()]; }
  // Another lane's record, after store().
  __device__ const T& of(Index lane) const { return records_[lane]; }
  // All lanes of a warp call this: the lane's record is written to to[at]; at = -1: the lane has none.
  __device__ void store(T* to, Index at) const {
    static_assert(sizeof(T) % sizeof(double) == 0);
    constexpr Index kUnits = sizeof(T) / sizeof(double), kLanes = kUnits <= 8 ? 8 : kUnits <= 16 ? 16 : 32;
    __syncwarp();
    for (Index first = 0; first < warpSize; first += warpSize / kLanes) {
      const Index owner = first + lane() / kLanes, element = __shfl_sync(~0u, at, owner);
      if (element < 0) continue;
      const auto* from = reinterpret_cast<const double*>(records_ + owner);
      auto* out = reinterpret_cast<double*>(to + element);
      for (Index unit = lane() % kLanes; unit < kUnits; unit += kLanes) out[unit] = from[unit];
    }
    __syncwarp();
  }

 private:
  __device__ static Index lane() { return static_cast<Index>(threadIdx.x % warpSize); }
  T* records_;
};

// A pointer with which an item may access only element i of the array: that element.
template <class T>
__device__ T* only(T& element, Index i) {
  return &element - i;
}

}  // namespace scree
