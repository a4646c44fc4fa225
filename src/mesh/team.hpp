// Who looks at the triangles of a row. Host and device.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// One alone. On a GPU some lanes of a warp do it together (cuda/lane_team.cuh): they take the triangles in
// turn, all have the same of what they agree on, and one of them, who leads, writes it down.
struct Alone {
  SCREE_HD static constexpr Index first() { return 0; }
  SCREE_HD static constexpr Index stride() { return 1; }
  SCREE_HD static constexpr bool leads() { return true; }
  // What merge makes of everyone's value; it is commutative and associative.
  template <class T, class Merge>
  SCREE_HD static T agree(const T& value, const Merge&) {
    return value;
  }
  // The value of who leads.
  template <class T>
  SCREE_HD static T of_leader(const T& value) {
    return value;
  }
};

}  // namespace scree
