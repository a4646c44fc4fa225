// What meshes of files often have and what can be put right without a guess.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Triangles of one kind that were put right.
struct RepairedTriangles {
  std::size_t count = 0;
  std::string first;  // triangle_text() of the first of them
};

struct MeshRepair {
  NumberedMesh mesh;
  RepairedTriangles without_area, twins;  // left out
  RepairedTriangles turned;               // of a sheet against most of their neighbours, else inwards
  std::size_t left = 0;                   // of the triangles given
};

// mesh: welded. Triangles without area and twins are left out, windings made alike, and of closed meshes
// outward; each kind as without_area.hpp, twin_triangles.hpp and windings.hpp say. A mesh that has none of
// these stays as it is, in the order of its triangles and vertices; so does one with numbers that are not
// finite, or so large that areas are not. What is wrong all the same mesh_troubles() finds.
MeshRepair repaired(NumberedMesh mesh, bool sheet);

// What was done, each kind with its count and its first triangle; "" where nothing was.
std::string repair_text(const MeshRepair& repair, bool sheet);

}  // namespace scree
