// What presses on the triangles of meshes and drags them along, at one instant. Exact sums: the same bits in
// any order of the contacts and for any split over ranks.
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

// Of one triangle's contacts.
struct TriangleSums {
  Index surface = 0, triangle = 0;  // of the placed surfaces; in its mesh's SurfaceMesh
  ExactSum normal;                  // force towards the surface, along the contacts' normals [N]
  ExactSum tangential[3];           // the rest of the force on the surface, global axes [N]

  std::pair<Index, Index> place() const { return {surface, triangle}; }
  void add(const TriangleSums& part);
};

// The same as numbers.
struct TriangleLoad {
  Index surface, triangle;
  Real normal;      // [N]
  Vec3 tangential;  // [N]
};

// Contacts of a rank's particles with meshes as they were found last; on the host.
struct MeshLoads {
  std::span<const MeshGroup> groups;
  // Per entry.
  std::span<const Index> surfaces;  // by number
  std::span<const MeshTouch> touches;
  std::span<const SurfaceLoad> loads;
};

// Of the triangles that something touches, ordered by place. numbers: with planes on the host.
std::vector<TriangleSums> triangle_sums(const MeshLoads& contacts, const SurfaceNumbers& numbers);

}  // namespace scree
