// Vertices of triangles that only have equal coordinates become one.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// The mesh with one vertex for all of equal coordinates (-0 is +0), numbered as the triangles first use them;
// those that no triangle uses are left out. The triangles keep their order.
TriangleMesh welded(const TriangleMesh& mesh);

// Triangles with the numbers that they had before some of them were left out.
struct NumberedMesh {
  TriangleMesh mesh;
  std::vector<Index> numbers;  // of each triangle
};
NumberedMesh numbered(TriangleMesh mesh);

// welded(), also for vertices at most `tolerance` [m] apart: each joins the first of those before it, in the
// order above, that is near enough and kept. Triangles that shrink to an edge by this are left out.
NumberedMesh welded_within(const TriangleMesh& mesh, Real tolerance);

}  // namespace scree
