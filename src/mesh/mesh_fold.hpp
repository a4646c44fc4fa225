// Concave edges whose angle exceeds the feature angle.
#pragma once

#include "mesh/mesh_parts.hpp"
#include "mesh/mesh_topology.hpp"

namespace scree {

struct MeshFold {
  Real angle = 0;  // between the faces there [rad]; 0: the mesh has no fold
  Vec3 position;   // middle of the edge, in the frame of the mesh [m]
};

// The fold with the smallest angle, the first of equals. A sphere of radius r in contact with one side of a
// fold of angle t leaves that side once it overlaps the other side by more than r (1 - cos t): the force of
// the first contact then ends within one step, so that the energy of an impact is not conserved. Folds of a
// closed mesh are concave seen from outside, of an open surface from either side. cosine: of the feature
// angle. Edges with more than two faces, and angles below 30 degrees whatever the feature angle is, are not
// considered.
MeshFold least_fold(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet);

}  // namespace scree
