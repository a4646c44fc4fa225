// Whether a point lies in the solid that a closed mesh encloses, however deep.
#pragma once

#include "base/vec3.hpp"
#include "mesh/mesh_view.hpp"

namespace scree {

// p: in the frame of the mesh, not nearer to its surface than round-off. A ray from p along +x, in the plane
// z = p.z, crosses the surface an odd number of times. Edges are cut by the plane, and the segments between
// the cuts by the ray, with one side of each closed and the same cut for both triangles of an edge: a ray
// that meets edges and vertices counts them right, and so does one along faces. In 2D p.z is 0, where the
// sides of a closed line are upright.
bool is_inside(const MeshView& mesh, Vec3 p);

}  // namespace scree
