// Triangulation of polygons with any number of corners, as files have them.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Appends the polygon of the mesh's vertices, at least three, cut into triangles of its winding: convex ones
// as a fan about the first corner, others by ear clipping. Returns "", or the reason why it cannot be cut,
// with nothing appended.
std::string add_polygon(TriangleMesh& mesh, const std::vector<Index>& corners);

}  // namespace scree
