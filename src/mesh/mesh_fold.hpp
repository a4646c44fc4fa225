// Concave edges at which a mesh turns by more than the feature angle.
#pragma once

#include "mesh/mesh_parts.hpp"
#include "mesh/mesh_topology.hpp"

namespace scree {

struct MeshFold {
  Real angle = 0;  // by which the faces turn there [rad]; 0: the mesh has no fold
  Vec3 position;   // middle of the edge, in the frame of the mesh [m]
};

// The fold that turns the least, the first of several that turn alike. A sphere of radius r that touches one
// side of a fold of angle t leaves that side once it overlaps the other side by more than r (1 - cos t): the
// force of the first contact then ends in one step, so that the energy of an impact is not conserved. Of a
// closed mesh folds are concave seen from outside, of a sheet from either side. cosine: of the feature angle.
// Not judged: edges with more than two faces, and those that turn by less than 30 degrees whatever the
// feature angle is.
MeshFold least_fold(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet);

}  // namespace scree
