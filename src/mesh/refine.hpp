// Refinement of meshes without change of their surface.
#pragma once

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// A welded mesh whose edges are all at most edge_length [m]. The longest edge above that is split at its
// middle, with all its triangles, until there is none (ties: the edge of lower vertices first), so that
// there are no hanging vertices and angles stay bounded (Rivara, Int. J. Numer. Meth. Eng. 20, 1984). Parts
// of a triangle take its position in the order. Curved shapes keep their facets; more segments bring them
// nearer to the true shape. Throws InputError where more than most_triangles would be made.
TriangleMesh refined(const TriangleMesh& mesh, Real edge_length, Index most_triangles = 100'000'000);

}  // namespace scree
