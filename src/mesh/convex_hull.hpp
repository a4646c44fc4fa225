// Convex hulls of points.
#pragma once

#include <vector>

#include "base/vec3.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// The closed mesh around all points [m], of some of them, corners counterclockwise seen from outside. Points
// count as they lie on a grid of 2^40 cells across their box, along each axis for itself, on which
// orientation is exact: no place is farther outside than such a cell. Throws InputError where the points lie
// in a plane, to 1e-9 of the volume of their box. Deterministic, but of points in one plane any triangles may
// come out. By Barber, Dobkin and Huhdanpaa, ACM Trans. Math. Softw. 22, 469 (1996).
TriangleMesh convex_hull(const std::vector<Vec3>& points);

}  // namespace scree
