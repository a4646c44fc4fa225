// Defects of triangles that are to form a surface.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Defects of a welded mesh that make it unfit as a contact surface: one text per kind, with the first five
// positions; empty: the mesh is sound. Triangles are counted from 0 in their order, or have the `numbers`
// given. Open (two-sided) meshes may have free edges, edges with more than two triangles and any windings.
std::vector<std::string> mesh_defects(const TriangleMesh& mesh, bool sheet,
                                      const std::vector<Index>& numbers = {});

// Text on intersecting shells of a closed mesh without other defects: their numbers, and the first position;
// empty where there are none. Contacts are found on such a mesh, but the volume that two shells share counts
// for both.
std::string crossing_text(const TriangleMesh& mesh, const std::vector<Index>& numbers = {});

// "triangle 12 (0, 0, 0) (1, 0, 0) (0, 1, 0)": its number and its corners.
std::string triangle_text(const TriangleMesh& mesh, Index triangle, Index number);

}  // namespace scree
