// Meshes of nearly the same surface with fewer triangles.
#pragma once

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

struct CoarseMesh {
  TriangleMesh mesh;
  Real moved = 0;  // the farthest that a vertex given is beside it [m]
};

// A sound welded mesh without some of its vertices: edges are collapsed into one of their ends, those first
// by which it stays nearest to the planes of the triangles given (Garland and Heckbert, SIGGRAPH 97, 209),
// the shorter of equals, as long as no vertex given is then farther than `distance` [m] from it. Sharp edges,
// which turn by more than feature_angle [rad], and free ones stay: their vertices go along them alone, and
// none comes where they end or fork. No edge becomes sharp, no triangle turns over or becomes a sliver, and
// what was closed stays closed. It depends on the triangles alone, not on their order: they come out in one
// of their own.
CoarseMesh coarsened(const TriangleMesh& mesh, Real distance, Real feature_angle);

}  // namespace scree
