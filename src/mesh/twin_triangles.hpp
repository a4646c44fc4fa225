// Triangles that stand more than once in a mesh: with the same three corners, run through either way.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Of triangles with the same corners the first stays. In a closed mesh none does where the others leave two
// triangles at each of the edges without it: a leaf on a surface, a wall between two solids with a face in
// common. mesh: welded, all triangles have areas. Returns the numbers of those left out, increasing.
std::vector<Index> leave_out_twins(NumberedMesh& mesh, bool sheet);

}  // namespace scree
