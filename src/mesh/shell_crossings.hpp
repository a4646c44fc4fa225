// Shells, and other parts, of one mesh that cut through each other.
#pragma once

#include <optional>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// The first crossing of two shells: the lowest triangle of the lower shell that crosses one of the other
// shell, and the lowest of these.
struct ShellCrossing {
  Index shell[2], triangle[2];  // the lower shell first
  Vec3 position;                // middle of the line along which the two triangles cross [m]
};

// The first crossing of every two shells that cross, in the order of the shells. Two triangles cross where
// the corners of each lie on both sides of the other one's plane and the two have a line in common; all three
// by more than kCrossingTolerance of the mesh's extent, so that shells which touch, as boxes that stand on
// each other, do not cross, whatever the round-off of a file's coordinates. shell_of_triangle: as shells_of()
// has them.
std::vector<ShellCrossing> shell_crossings(const TriangleMesh& mesh,
                                           const std::vector<Index>& shell_of_triangle);
inline constexpr Real kCrossingTolerance = 1e-6;

// The first two triangles without a common vertex that cross, be they of one shell or of two.
struct OwnCrossing {
  Index triangle[2];  // the lower one first
  Vec3 position;      // as of a ShellCrossing [m]
};
std::optional<OwnCrossing> own_crossing(const TriangleMesh& mesh);

// The shells that cut through others, increasing.
std::vector<Index> crossing_shells(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle);

}  // namespace scree
