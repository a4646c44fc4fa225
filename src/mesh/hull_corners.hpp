// The corners of a mesh that a plane can touch: those of its convex hull.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Strict corners only: points inside a face or an edge of the hull are not among them. A box has eight,
// however finely its faces are divided.
struct HullCorners {
  std::vector<Vec3> corners;        // [m], in an order that depends on the points alone
  std::vector<Index> first;         // per face its first entry of face_corners, and the end
  std::vector<Index> face_corners;  // per face its corners, which are coplanar; in 2D the ends of an edge
  std::vector<Vec3> normals;        // per face, unit, outwards
  Vec3 middle;                      // no corner is farther from it than `bounding_radius` [m]
  Real bounding_radius = 0;
  // Radius of the sphere with the surface area of the hull; in 2D of the circle with the length of the
  // hull's outline [m].
  Real radius = 0;

  Index faces() const { return static_cast<Index>(normals.size()); }
  std::span<const Index> of_face(Index face) const {
    const auto f = static_cast<std::size_t>(face);
    return {face_corners.data() + first[f], static_cast<std::size_t>(first[f + 1] - first[f])};
  }
};

// The strict corners of these points, which are not all on one line in space, nor all at one position.
// planar: points in the plane z = 0, for dimension 2. Hulls flatter than 1e-9 of their extent count as flat.
HullCorners hull_corners(const std::vector<Vec3>& points, bool planar);

}  // namespace scree
