// The edges and vertices of a mesh that a sphere may touch.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/mesh_parts.hpp"
#include "mesh/mesh_topology.hpp"
#include "mesh/mesh_view.hpp"

namespace scree {

struct MeshFeatures {
  std::vector<MeshTriangle> triangles;  // with the features that they own
  std::vector<MeshFeature> features;    // ordered by their owners
  std::vector<Index> tests, patches;
};

// sheet: the mesh is two-sided; otherwise edges that are concave from outside are left out.
MeshFeatures mesh_features(const MeshTopology& topology, const MeshParts& parts, bool sheet);

}  // namespace scree
