// Intersections of shells, and of other parts, of one mesh.
#pragma once

#include <optional>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// The first intersection of two shells: the lowest triangle of the lower shell that intersects the other
// shell, and the lowest triangle that it intersects.
struct ShellCrossing {
  Index shell[2], triangle[2];  // the lower shell first
  Vec3 position;                // middle of the intersection of the two triangles [m]
};

// The first intersection of every pair of intersecting shells, in the order of the shells. Two triangles
// intersect where the corners of each lie on both sides of the other one's plane and the two have a segment
// in common; all three by more than kCrossingTolerance of the mesh's extent. Shells in touch, as boxes that
// stand on each other, therefore do not intersect, whatever the round-off of a file's coordinates.
// shell_of_triangle: from shells_of().
std::vector<ShellCrossing> shell_crossings(const TriangleMesh& mesh,
                                           const std::vector<Index>& shell_of_triangle);
inline constexpr Real kCrossingTolerance = 1e-6;

// The first intersection of two triangles without a common vertex, of one shell or of two.
struct OwnCrossing {
  Index triangle[2];  // the lower one first
  Vec3 position;      // as in ShellCrossing [m]
};
std::optional<OwnCrossing> own_crossing(const TriangleMesh& mesh);

// The shells that intersect others, increasing.
std::vector<Index> crossing_shells(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle);

}  // namespace scree
