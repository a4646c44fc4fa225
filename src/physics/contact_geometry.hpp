// Geometry of a contact of two surfaces at one instant, shared by all laws.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"

namespace scree {

// Overlap of i and j and the unit normal from j to i. The normal is stored as scale * direction, because most
// uses need only products with it. T, Vector: double, or single where a GPU computes forces in mixed
// precision. Paper's Eqs. 19-21, 23, 24.
template <class T, class Vector>
struct ContactGeometryOf {
  T overlap;   // d [m], positive when touching
  T distance;  // between the centres; from a plane to i's centre [m]
  Vector direction;
  T scale;  // 1 / |direction|

  SCREE_HD Vector normal() const { return scale * direction; }
  // Overlap rate d_dot [m/s], positive when approaching. velocity: of i relative to j [m/s].
  SCREE_HD T rate(Vector velocity) const { return -scale * dot(direction, velocity); }
  // Force vector of this normal force [N].
  SCREE_HD Vector along(T force) const { return (force * scale) * direction; }
};
using ContactGeometry = ContactGeometryOf<Real, Vec3>;

// Two spheres; r: position of i relative to j [m].
template <class T, class Vector>
SCREE_HD ContactGeometryOf<T, Vector> sphere_pair(Vector r, T radius_sum) {
  const RootAndInverse<T> distance = root_and_inverse(dot(r, r));
  return {radius_sum - distance.root, distance.root, r, distance.inverse};
}

// A sphere and a half space; normal: unit vector into the free side.
SCREE_HD ContactGeometry plane_pair(Vec3 center, Real radius, Vec3 point, Vec3 normal) {
  const Real distance = dot(center - point, normal);
  return {radius - distance, distance, normal, 1};
}

// Radii and masses of the two partners. Planes have no curvature; walls are infinitely heavy, and so are
// bodies in contact with particles where a law reads their mass alone.
template <class T>
struct PairSizeOf {
  T radius_i, radius_j;  // [m]; infinite for a plane
  T mass_i, mass_j;      // [kg]; infinite for immovable partners
  // What the motion of bodies adds to 1/m* [1/kg]: their inverse masses, unless mass_i and mass_j have them,
  // and the part (r x n).J^-1 (r x n) of their rotation.
  T of_bodies = 0;

  SCREE_HD T effective_radius() const { return inverse(inverse(radius_i) + inverse(radius_j)); }
  // m*, the effective mass of a motion along the normal.
  SCREE_HD T effective_mass() const { return inverse(inverse(mass_i) + inverse(mass_j) + of_bodies); }
};
using PairSize = PairSizeOf<Real>;

// State of a contact at one instant, as its law reads it.
template <class T, class Vector>
struct PairStateOf {
  ContactGeometryOf<T, Vector> geometry;
  Vector velocity;  // of i relative to j [m/s]
  PairSizeOf<T> size;
};
using PairState = PairStateOf<Real, Vec3>;

// Vector from i's centre to the contact point [m]. Two spheres divide the distance of their centres in the
// ratio of their radii, so that both arms add up to it; on a plane the contact point is the foot of the
// perpendicular.
SCREE_HD Vec3 contact_arm(const PairState& pair) {
  const Real i = pair.size.radius_i, j = pair.size.radius_j;
  return pair.geometry.along(j < kInfinity ? -i / (i + j) * pair.geometry.distance : -pair.geometry.distance);
}

}  // namespace scree
