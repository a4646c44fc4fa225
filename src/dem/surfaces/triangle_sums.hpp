// Normal and tangential loads on the triangles of meshes at one instant. The sums are exact: they have the
// same bits for any order of the contacts and any distribution over ranks.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/exact_sum.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/surfaces/mesh_rows.hpp"
#include "dem/surfaces/surface_sums.hpp"
#include "dem/surfaces/surfaces.hpp"

namespace scree {

// Sums over the contacts of one triangle.
struct TriangleSums {
  Index surface = 0, triangle = 0;  // number of the placed surface; index in its SurfaceMesh
  ExactSum normal;                  // force towards the surface, along the contacts' normals [N]
  ExactSum tangential[3];           // tangential force on the surface, global axes [N]

  std::pair<Index, Index> key() const { return {surface, triangle}; }
  void add(const TriangleSums& part);
};

// Rounded sums of a triangle.
struct TriangleLoad {
  Index surface, triangle;
  Real normal;      // [N]
  Vec3 tangential;  // [N]
};

// Contacts of a rank's particles with meshes from the last evaluation; on the host.
struct MeshLoads {
  std::span<const MeshGroup> groups;
  // Per entry.
  std::span<const Index> surfaces;  // by surface number
  std::span<const MeshTouch> touches;
  std::span<const SurfaceLoad> loads;
};

// Sums of the triangles in contact, ordered by key(). numbers: with planes on the host.
std::vector<TriangleSums> triangle_sums(const MeshLoads& contacts, const SurfaceNumbers& numbers);

}  // namespace scree
