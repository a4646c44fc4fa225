// Duplicate triangles: with the same three corners, in either winding.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Removes duplicates; the first of the triangles with the same corners stays. In a closed mesh none stays
// where the others leave two triangles at each of its edges: a leaf on a surface, or a wall between two
// solids with a common face. mesh: welded, without degenerate triangles. Returns the numbers of the removed
// triangles, increasing.
std::vector<Index> remove_duplicates(NumberedMesh& mesh, bool sheet);

}  // namespace scree
