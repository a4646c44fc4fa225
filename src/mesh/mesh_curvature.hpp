// How curved the smooth surfaces are that the facets of a mesh stand for.
#pragma once

#include "mesh/mesh_parts.hpp"
#include "mesh/mesh_topology.hpp"

namespace scree {

// Estimated from the turns over the edges of every two facets of a smooth patch, over their area
// (Cohen-Steiner and Morvan, Symp. Comput. Geom. 19, 2003); exact for equal facets around a circle. A turn
// that does not go on at the next edges is a crease, of which no curve is known.
struct MeshCurvature {
  Real concave_radius = kInfinity;  // least, seen from outside, of a sheet from either side [m]
  Real sag = 0;                     // largest, between a facet and the curve [m]
};

// cosine: of the feature angle.
MeshCurvature mesh_curvature(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet);

}  // namespace scree
