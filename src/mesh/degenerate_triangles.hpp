// Degenerate triangles: three collinear corners, or a repeated corner.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Whether the corners span a plane. Below a height of 1e-12 of the longest side, round-off determines the
// normal.
bool has_area(const TriangleCorners& corners);

// Removes the degenerate triangles, none of which adds a point to the surface, and keeps their neighbours
// connected: where the middle of three collinear corners splits the edge between the other two, the
// triangles across that edge are split there, too; of corners that coincide but for round-off the second
// becomes the first. mesh: welded, with finite coordinates. Returns the numbers of the removed triangles,
// increasing.
std::vector<Index> remove_degenerate(NumberedMesh& mesh);

}  // namespace scree
