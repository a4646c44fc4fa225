// Regions in which particles are removed.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

inline constexpr int kMostOutlets = 8;  // of a deck

enum class OutletShape { box, cylinder, sphere };

// A region at one instant. Local coordinates: (p - origin) along the axes. A half space is a box
// with a single finite bound.
struct OutletRegion {
  OutletShape shape = OutletShape::box;
  Vec3 origin;      // [m]
  Vec3 x, y, z;     // axes, unit vectors in the global frame
  Vec3 min, max;    // box: local bounds, which may be infinite; cylinder about z: those along z [m]
  Real radius = 0;  // cylinder, sphere [m]

  SCREE_HD bool contains(Vec3 p) const {
    const Vec3 d = p - origin, q{dot(d, x), dot(d, y), dot(d, z)};
    switch (shape) {
      case OutletShape::box:
        return q.x >= min.x && q.x <= max.x && q.y >= min.y && q.y <= max.y && q.z >= min.z && q.z <= max.z;
      case OutletShape::cylinder:
        return q.x * q.x + q.y * q.y <= radius * radius && q.z >= min.z && q.z <= max.z;
      case OutletShape::sphere:
        break;
    }
    return dot(q, q) <= radius * radius;
  }
};

}  // namespace scree
