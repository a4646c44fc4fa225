// Meshes of bodies on planes: a plane can touch the corners of a mesh's convex hull alone.
#pragma once

#include "base/log.hpp"
#include "model/data/model.hpp"

namespace scree {

// Finds the corners of the meshes that bodies have, where there are planes; after both are built.
void build_mesh_corners(Model& model);

// Whether a mesh of a body may touch planes: not where it lies across one at t = 0 and something holds the
// body to the ground there, as a shaft that goes through a wall.
bool may_meet_planes(const Model& model, std::size_t body, const MeshShape& shape);
// The same, and the deck has a law for it with one of the planes.
bool meets_planes(const Model& model, std::size_t body, const MeshShape& shape);
// A plane that the mesh lies across at t = 0, further than round-off and contacts go; null: none.
const Wall* plane_across(const Model& model, std::size_t body, const MeshShape& shape);
// Warns of bodies that are held, on planes that they would touch but for lying across them.
void warn_of_meshes_across(const Model& model, Log& log);
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
