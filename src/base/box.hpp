// A box and its containment test, on host and device.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Sides may be at infinity.
struct Box {
  Vec3 min, max;  // [m]
  // Whether p is inside by at least `margin`, or for a negative margin outside by at most -margin [m]. False
  // for a NaN.
  SCREE_HD bool inside(Vec3 p, Real margin = 0) const {
    return p.x - margin >= min.x && p.x + margin <= max.x && p.y - margin >= min.y && p.y + margin <= max.y &&
           p.z - margin >= min.z && p.z + margin <= max.z;
  }
  // Whether p is inside the box, or outside by at most `width` [m].
  SCREE_HD bool is_within(Vec3 p, Real width) const { return inside(p, -width); }
  // Whether p is outside a side. False for a NaN.
  SCREE_HD bool beyond(Vec3 p) const {
    return p.x < min.x || p.x > max.x || p.y < min.y || p.y > max.y || p.z < min.z || p.z > max.z;
  }
};

}  // namespace scree
