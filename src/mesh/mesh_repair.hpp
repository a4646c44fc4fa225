// Defects that are frequent in mesh files and that have a unique repair.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Triangles with one kind of repair.
struct RepairedTriangles {
  std::size_t count = 0;
  std::string first;  // triangle_text() of the first one
};

struct MeshRepair {
  NumberedMesh mesh;
  RepairedTriangles without_area, twins;  // removed
  RepairedTriangles turned;  // reoriented: of an open surface, those against most of their neighbours; else,
                             // those that point inwards
  std::size_t left = 0;      // number of original triangles that remain
};

// mesh: welded. Degenerate and duplicate triangles are removed, windings are made consistent, and outward on
// closed meshes; see degenerate_triangles.hpp, duplicate_triangles.hpp and windings.hpp. A mesh without these
// defects is unchanged, also in the order of its triangles and vertices; so is one with numbers that are not
// finite, or so large that areas are not. mesh_defects() finds the remaining defects.
MeshRepair repaired(NumberedMesh mesh, bool sheet);

// The repairs, each kind with its count and its first triangle; empty where there were none.
std::string repair_text(const MeshRepair& repair, bool sheet);

}  // namespace scree
