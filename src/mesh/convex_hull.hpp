// Convex hulls of points.
#pragma once

#include <vector>

#include "base/vec3.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// The closed convex mesh of these points [m], with some of them as vertices, corners counterclockwise seen
// from outside. Points are rounded to a grid of 2^40 cells across their box, along each axis separately, on
// which orientation is exact: no point is farther outside than one such cell. Throws InputError where the
// points are coplanar, to 1e-9 of the volume of their box. Deterministic, but the triangulation of coplanar
// points is arbitrary. By Barber, Dobkin and Huhdanpaa, ACM Trans. Math. Softw. 22, 469 (1996).
TriangleMesh convex_hull(const std::vector<Vec3>& points);

}  // namespace scree
