// Adjacency of the triangles, edges and vertices of a mesh, with triangles ordered along a space-filling
// curve.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// A triangle at an edge.
struct EdgeUse {
  Index triangle;
  bool reversed;  // whether it runs from the higher vertex to the lower one
};

struct MeshEdge {
  Index low, high;        // vertices
  Index first_use, uses;  // into MeshTopology::uses, by increasing triangle
};

// Lists of different lengths in one array: list i is items[first[i]] to items[first[i + 1]].
struct IndexLists {
  std::vector<Index> first, items;

  std::span<const Index> of(Index i) const {
    return std::span(items).subspan(first[i], static_cast<std::size_t>(first[i + 1] - first[i]));
  }
};

struct MeshTopology {
  TriangleMesh mesh;            // triangles along the Morton curve of their centres, vertices by first use
  std::vector<Index> original;  // number of each triangle in the original mesh
  std::vector<MeshEdge> edges;
  std::vector<EdgeUse> uses;
  std::vector<std::array<Index, 3>> edges_of;  // per triangle, starting at corner k
  IndexLists triangles_at;                     // per vertex, increasing

  std::span<const EdgeUse> uses_of(const MeshEdge& edge) const {
    return std::span(uses).subspan(edge.first_use, edge.uses);
  }
  // Whether exactly two triangles share the edge, with consistent windings.
  bool joins_two(const MeshEdge& edge) const {
    return edge.uses == 2 && uses[edge.first_use].reversed != uses[edge.first_use + 1].reversed;
  }
  // The triangle across an edge for which joins_two().
  Index across(const MeshEdge& edge, Index triangle) const {
    const Index first = uses[edge.first_use].triangle;
    return first != triangle ? first : uses[edge.first_use + 1].triangle;
  }
};

MeshTopology mesh_topology(const TriangleMesh& mesh);

}  // namespace scree
