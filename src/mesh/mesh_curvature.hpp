// Curvature of the smooth surfaces that the facets of a mesh approximate.
#pragma once

#include "mesh/mesh_parts.hpp"
#include "mesh/mesh_topology.hpp"

namespace scree {

// Estimated from the angles at the edges of every two facets of a smooth patch, over their area
// (Cohen-Steiner and Morvan, Symp. Comput. Geom. 19, 2003); exact for equal facets around a circle. An edge
// whose angle does not continue at the next edges is a crease, which has no curvature.
struct MeshCurvature {
  Real concave_radius = kInfinity;  // smallest, seen from outside; of an open surface from either side [m]
  Real sag = 0;                     // largest distance between a facet and the curve [m]
};

// cosine: of the feature angle.
MeshCurvature mesh_curvature(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet);

}  // namespace scree
