// Meshes of bodies on planes: a plane can touch the corners of a mesh's convex hull alone.
#pragma once

#include "model/model.hpp"

namespace scree {

// Finds the corners of the meshes that bodies have, where there are planes; after both are built.
void build_mesh_corners(Model& model);

// Whether a mesh of a body touches one of the planes.
bool meets_planes(const Model& model, const MeshShape& shape);
// The largest of the effective radii of the meshes that touch planes; 0: there are none [m].
Real largest_corner_radius(const Model& model);

// The fastest oscillation of a body on all corners of a face of its mesh, or on one of them, which lie on a
// plane. Of the bodies that joints and the like hold to the ground, or of those that they do not.
struct CornerOscillation {
  Real frequency = 0;    // [rad/s]; 0: no mesh touches a plane
  bool is_exact = true;  // else the stiffness is an estimate, as it depends on the overlap
};
CornerOscillation fastest_on_corners(const Model& model, bool held);

}  // namespace scree
