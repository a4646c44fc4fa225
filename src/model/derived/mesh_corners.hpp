// Contact of bodies' meshes with planes: a plane touches only the vertices of a mesh's convex hull.
#pragma once

#include "base/log.hpp"
#include "model/data/model.hpp"

namespace scree {

// Finds these vertices for the meshes of bodies, where there are planes. Called after both are built.
void build_mesh_corners(Model& model);

// Whether a mesh of a body may touch planes. It may not where it intersects a plane at t = 0 and the body is
// held to the ground there, such as a shaft through a wall.
bool may_touch_planes(const Model& model, std::size_t body, const MeshShape& shape);
// Whether the mesh may touch planes and the deck has a law for it with one of them.
bool touches_planes(const Model& model, std::size_t body, const MeshShape& shape);
// A plane that the mesh intersects at t = 0 beyond round-off and contact overlaps; null: none.
const Wall* plane_across(const Model& model, std::size_t body, const MeshShape& shape);
// Warns of held bodies and planes that have no contact because they intersect at t = 0.
void warn_of_meshes_across(const Model& model, Log& log);
// The largest effective radius of the meshes that touch planes; 0 without any [m].
Real largest_corner_radius(const Model& model);

// The highest oscillation frequency of a body on all vertices of a face of its mesh, or on a single vertex,
// in contact with a plane: for bodies that joints or force elements hold to the ground, or for all others.
struct CornerOscillation {
  Real frequency = 0;    // [rad/s]; 0: no mesh touches a plane
  bool is_exact = true;  // false: the stiffness depends on the overlap and is estimated
};
CornerOscillation fastest_on_corners(const Model& model, bool held);

}  // namespace scree
