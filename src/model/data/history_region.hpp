// A region whose particles the history counts.
#pragma once

#include <string>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/choices.hpp"

namespace scree {

// Geometry of a region, boundary included.
struct RegionBounds {
  RegionKind kind = RegionKind::box;
  Vec3 min, max;    // box: lower and upper corner [m]
  Vec3 center;      // sphere; cylinder: one end of the axis [m]
  Vec3 axis;        // cylinder: from that end to the other one [m]
  Real radius = 0;  // sphere, cylinder [m]

  SCREE_HD bool holds(Vec3 p) const {
    if (kind == RegionKind::box)
      return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z && p.z <= max.z;
    const Vec3 arm = p - center;
    if (kind == RegionKind::sphere) return dot(arm, arm) <= radius * radius;
    const Real along = dot(arm, axis), length = dot(axis, axis);
    if (along < 0 || along > length) return false;
    const Vec3 moment = cross(arm, axis);  // of length (distance from the axis) |axis|
    return dot(moment, moment) <= radius * radius * length;
  }
};

struct HistoryRegion {
  std::string name;
  RegionBounds bounds;
};

// Particles whose centres a region holds.
struct RegionSums {
  Real number = 0, mass = 0;  // number: a whole number; mass [kg]
};

}  // namespace scree
