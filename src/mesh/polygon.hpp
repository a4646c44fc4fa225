// Faces of files with any number of corners.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Appends the polygon of the mesh's vertices, at least three, cut into triangles of its winding: convex ones
// as a fan about the first corner, others ear by ear. Returns "", or why it cannot be cut: then nothing is
// appended.
std::string add_polygon(TriangleMesh& mesh, const std::vector<Index>& corners);

}  // namespace scree
