// Test whether a point lies in the solid that a closed mesh encloses, at any depth.
#pragma once

#include "base/vec3.hpp"
#include "mesh/mesh_view.hpp"

namespace scree {

// p: in the frame of the mesh, farther from its surface than round-off. From a point inside, a ray along +x
// in the plane z = p.z crosses the surface an odd number of times. Edges are cut by the plane, and the
// segments between the cuts by the ray; one side of each is closed, and both triangles of an edge use the
// same cut. A ray through edges and vertices is therefore counted correctly, and so is one along faces. In
// 2D p.z is 0, where the sides of a closed line are upright.
bool is_inside(const MeshView& mesh, Vec3 p);
// Whether a sphere at p, in the frame of the mesh, is inside it and touches no triangle [m].
bool contains_sphere(const MeshView& mesh, Vec3 p, Real radius);

}  // namespace scree
