// Coplanar parts of a mesh, and the smooth patches that they make up.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/mesh_topology.hpp"
#include "mesh/mesh_view.hpp"

namespace scree {

struct MeshParts {
  std::vector<MeshPart> parts;  // in the order of their lowest triangles
  std::vector<Index> part_of;   // for each triangle
  IndexLists neighbours;        // for each patch, increasing: the patches with which it shares an edge
};

// flatness: how far the vertices of a part may be from its plane [m]; cosine: of the feature angle.
MeshParts mesh_parts(const MeshTopology& topology, Real flatness, Real cosine);

// A normal of any length as a unit vector without -0.
Vec3 unit_normal(Vec3 normal);

}  // namespace scree
