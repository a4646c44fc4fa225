// Triangles without area: three corners on one line, or one corner twice.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Whether it spans a plane: less high over its longest side than 1e-12 of that, round-off alone turns its
// normal.
bool has_area(const TriangleCorners& corners);

// Leaves out the triangles without area, none of which adds a point to the surface, and keeps together what
// they join: where the middle one of three corners on a line splits the edge between the other two, the
// triangles across that edge are split there, too; of corners that lie on each other but for round-off the
// second becomes the first. mesh: welded, coordinates are finite. Returns their numbers, increasing.
std::vector<Index> leave_out_without_area(NumberedMesh& mesh);

}  // namespace scree
