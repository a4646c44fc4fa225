// How two surfaces lie to each other at one instant: the geometry of a contact, once for every law.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"

namespace scree {

// Overlap of i and j and the normal between them, a unit vector from j to i: scale * direction, whose
// components many readers need not know one by one. T, Vector: double, or single where a GPU computes forces
// in mixed precision. Paper's Eqs. 19-21, 23, 24.
template <class T, class Vector>
struct ContactGeometryOf {
  T overlap;   // d [m], positive when touching
  T distance;  // of the centres; of i's centre from a plane [m]
  Vector direction;
  T scale;  // 1 / |direction|

  SCREE_HD Vector normal() const { return scale * direction; }
  // Overlap rate d_dot [m/s], positive when approaching. velocity: of i relative to j.
  SCREE_HD T rate(Vector velocity) const { return -scale * dot(direction, velocity); }
  // A force of this size along the normal.
  SCREE_HD Vector along(T force) const { return (force * scale) * direction; }
};
using ContactGeometry = ContactGeometryOf<Real, Vec3>;

// Of two spheres; r: position of i less that of j.
template <class T, class Vector>
SCREE_HD ContactGeometryOf<T, Vector> sphere_pair(Vector r, T radius_sum) {
  const RootAndInverse<T> distance = root_and_inverse(dot(r, r));
  return {radius_sum - distance.root, distance.root, r, distance.inverse};
}

// Of a sphere and a half space; normal: unit, into its free side.
SCREE_HD ContactGeometry plane_pair(Vec3 center, Real radius, Vec3 point, Vec3 normal) {
  const Real distance = dot(center - point, normal);
  return {radius - distance, distance, normal, 1};
}

// What a law may want to know of the two partners. A wall has no curvature; walls, and bodies that a particle
// touches, count as unmovable.
template <class T>
struct PairSizeOf {
  T radius_i, radius_j;  // [m]; infinite for a plane
  T mass_i, mass_j;      // [kg]; infinite for what does not give way

  SCREE_HD T effective_radius() const { return 1 / (1 / radius_i + 1 / radius_j); }
  SCREE_HD T effective_mass() const { return 1 / (1 / mass_i + 1 / mass_j); }
};
using PairSize = PairSizeOf<Real>;

// All that the law of a contact sees of it at one instant.
template <class T, class Vector>
struct PairStateOf {
  ContactGeometryOf<T, Vector> geometry;
  Vector velocity;  // of i relative to j [m/s]
  PairSizeOf<T> size;
};
using PairState = PairStateOf<Real, Vec3>;

// From i's centre to where the two touch [m]. Spheres share the distance of their centres in the ratio of
// their radii, so that the arms of both add to it; on a plane it is the foot of the perpendicular.
SCREE_HD Vec3 contact_arm(const PairState& pair) {
  const Real i = pair.size.radius_i, j = pair.size.radius_j;
  return pair.geometry.along(j < kInfinity ? -i / (i + j) * pair.geometry.distance : -pair.geometry.distance);
}

}  // namespace scree
