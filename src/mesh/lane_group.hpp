// Groups of threads that query the triangles of a row together. Host and device.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// The group of a single thread. On a GPU some lanes of a warp share the work (cuda/lane_team.cuh): they take
// the triangles in turn, agree on common results, and one of them, the leader, writes these.
struct SingleLane {
  SCREE_HD static constexpr Index first() { return 0; }
  SCREE_HD static constexpr Index stride() { return 1; }
  SCREE_HD static constexpr bool is_leader() { return true; }
  // Reduction of the values of all members; merge is commutative and associative.
  template <class T, class Merge>
  SCREE_HD static T reduce(const T& value, const Merge&) {
    return value;
  }
  // The leader's value, broadcast to all members.
  template <class T>
  SCREE_HD static T from_leader(const T& value) {
    return value;
  }
};

}  // namespace scree
