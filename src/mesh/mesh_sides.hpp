// Edges of all triangles (half-edges), sorted so that those of one edge of the mesh are together.
#pragma once

#include <algorithm>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// An edge of a triangle, from its lower to its higher vertex.
struct Side {
  Index low, high, triangle;
  bool forward;  // direction in the triangle
  auto operator<=>(const Side&) const = default;
};

// Sorted by edge, then triangle. Edges from a vertex to itself are left out.
inline std::vector<Side> sides_of(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (Index i = 0; i < static_cast<Index>(mesh.triangles.size()); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Index a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), i, a < b});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

// Calls visit(first, last) with the half-edges of each edge.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, Visit visit) {
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].low == sides[first].low &&
           sides[last].high == sides[first].high)
      ++last;
    visit(&sides[first], &sides[first] + (last - first));
  }
}

}  // namespace scree
