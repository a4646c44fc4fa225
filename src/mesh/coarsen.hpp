// Meshes of nearly the same surface with fewer triangles.
#pragma once

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

struct CoarseMesh {
  TriangleMesh mesh;
  Real moved = 0;  // largest distance of an original vertex from the mesh [m]
};

// A sound welded mesh with some of its vertices removed. Edges are collapsed into one of their ends, in the
// order of the distance from the planes of the original triangles (Garland and Heckbert, SIGGRAPH 97, 209)
// and, where equal, of their length, as long as every original vertex stays within `distance` [m] of the
// mesh. Sharp edges, at which the normals differ by more than feature_angle [rad], and free edges are
// preserved: their vertices are collapsed along them only, and vertices where they end or fork stay. No edge
// becomes sharp, no triangle is inverted or becomes a sliver, and closed meshes stay closed. The result does
// not depend on the order of the triangles; it has an order of its own.
CoarseMesh coarsened(const TriangleMesh& mesh, Real distance, Real feature_angle);

}  // namespace scree
