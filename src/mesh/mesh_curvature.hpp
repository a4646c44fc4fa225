// How curved the smooth surfaces are that the facets of a mesh stand for.
#pragma once

#include "mesh/mesh_parts.hpp"
#include "mesh/mesh_topology.hpp"

namespace scree {

// Estimated from the turn over every edge between facets of a smooth patch and how far their centroids are
// from the edge; exact for equal facets around a circle.
struct MeshCurvature {
  Real concave_radius = kInfinity;  // least, seen from outside, of a sheet from either side [m]
  Real sag = 0;                     // largest, between a facet and the curve [m]
};

// cosine: of the feature angle.
MeshCurvature mesh_curvature(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet);

}  // namespace scree
