// Lanes of a warp that search the triangles of a row together: mesh/lane_group.hpp on the device.
#pragma once

#include <cstring>

#include "base/types.hpp"

namespace scree {

// kLanes: lanes per group, a power of two; consecutive lanes of a warp form a group. All lanes of a group
// call its functions together.
template <int kLanes>
struct LaneTeam {
  static_assert(32 % kLanes == 0);

  __device__ static Index first() { return static_cast<Index>(threadIdx.x % kLanes); }
  __device__ static constexpr Index stride() { return kLanes; }
  __device__ static bool is_leader() { return first() == 0; }
  // kApart: lanes whose numbers differ by a multiple of it are reduced, each such set to a value of its own.
  template <int kApart = 1, class T, class Merge>
  __device__ static T reduce(T value, const Merge& merge) {
#pragma unroll
    for (int across = kLanes / 2; across >= kApart; across /= 2)
      value = merge(
          value, moved(value, [&](unsigned word) { return __shfl_xor_sync(lanes(), word, across, kLanes); }));
    return value;
  }
  template <class T>
  __device__ static T from_leader(const T& value) {
    return moved(value, [](unsigned word) { return __shfl_sync(lanes(), word, 0, kLanes); });
  }

 private:
  // number within the warp
  __device__ static unsigned lanes() {
    constexpr unsigned kFirst = kLanes == 32 ? ~0u : (1u << kLanes % 32) - 1;
    return kFirst << (threadIdx.x % 32 / kLanes * kLanes);
  }
  // Another lane's value, shuffled word by word.
  template <class T, class Move>
  __device__ static T moved(const T& value, const Move& move) {
    static_assert(sizeof(T) % sizeof(unsigned) == 0);
    unsigned words[sizeof(T) / sizeof(unsigned)];
    std::memcpy(words, &value, sizeof(T));
#pragma unroll
    for (unsigned& word : words) word = move(word);
    T out;
    std::memcpy(&out, words, sizeof(T));
    return out;
  }
};

}  // namespace scree
