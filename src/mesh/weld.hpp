// Welding: vertices with equal coordinates become one.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// The mesh with one vertex for all of equal coordinates (-0 is +0), numbered in the order of their first
// use; unused vertices are removed. The triangles keep their order.
TriangleMesh welded(const TriangleMesh& mesh);

// Triangles with their numbers in the original mesh.
struct NumberedMesh {
  TriangleMesh mesh;
  std::vector<Index> numbers;  // per triangle
};
NumberedMesh numbered(TriangleMesh mesh);

// Extends welded() to vertices at most `tolerance` [m] apart: each joins the first earlier vertex, in that
// order, that is near enough and itself kept. Triangles that collapse to an edge are removed.
NumberedMesh welded_within(const TriangleMesh& mesh, Real tolerance);

}  // namespace scree
