#include "mesh/mesh_topology.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "mesh/mesh_sides.hpp"

namespace scree {

namespace {

constexpr int kMortonBits = 21;  // per direction

// The bits of x, separated by two zeros each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

// Numbers of the triangles along the Morton curve of their centres; ties in the order of the file.
std::vector<Index> along_curve(const TriangleMesh& mesh) {
  Vec3 min{kInfinity, kInfinity, kInfinity}, max = -min;
  for (const Vec3 v : mesh.vertices) {
    min = {std::min(min.x, v.x), std::min(min.y, v.y), std::min(min.z, v.z)};
    max = {std::max(max.x, v.x), std::max(max.y, v.y), std::max(max.z, v.z)};
  }
  const Real extent = std::max({max.x - min.x, max.y - min.y, max.z - min.z});
  const Real cells = (1 << kMortonBits) - 1;
  const auto cell = [&](Real x) {
    return spread(static_cast<std::uint64_t>(std::clamp(x / extent, Real(0), Real(1)) * cells));
  };
  std::vector<std::pair<std::uint64_t, Index>> order;
  order.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 center = Real(1) / 3 * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) - min;
    order.emplace_back(cell(center.x) | cell(center.y) << 1 | cell(center.z) << 2,
                       static_cast<Index>(order.size()));
  }
  std::sort(order.begin(), order.end());
  std::vector<Index> numbers(order.size());
  std::transform(order.begin(), order.end(), numbers.begin(), [](const auto& one) { return one.second; });
  return numbers;
}

// The triangles in the order given, with vertices in the order of their first use.
TriangleMesh reordered(const TriangleMesh& mesh, const std::vector<Index>& order) {
  TriangleMesh result;
  std::vector<Index> number(mesh.vertices.size(), -1);
  for (const Index t : order) {
    auto& triangle = result.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      Index& v = number[mesh.triangles[t][k]];
      if (v < 0) {
        v = static_cast<Index>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[mesh.triangles[t][k]]);
      }
      triangle[k] = v;
    }
  }
  return result;
}

void find_edges(MeshTopology& topology) {
  const TriangleMesh& mesh = topology.mesh;
  topology.edges_of.resize(mesh.triangles.size());
  for_each_edge(sides_of(mesh), [&](const Side* first, const Side* last) {
    const Index edge = static_cast<Index>(topology.edges.size());
    topology.edges.push_back({first->low, first->high, static_cast<Index>(topology.uses.size()),
                              static_cast<Index>(last - first)});
    for (const Side* side = first; side != last; ++side) {
      const auto& corners = mesh.triangles[side->triangle];
      const auto from = std::find(corners.begin(), corners.end(), side->forward ? side->low : side->high);
      topology.uses.push_back({side->triangle, !side->forward});
      topology.edges_of[side->triangle][from - corners.begin()] = edge;
    }
  });
}

IndexLists triangles_at_vertices(const TriangleMesh& mesh) {
  IndexLists at;
  at.first.assign(mesh.vertices.size() + 1, 0);
  for (const auto& triangle : mesh.triangles)
    for (const Index v : triangle) ++at.first[v + 1];
  std::partial_sum(at.first.begin(), at.first.end(), at.first.begin());
  at.items.resize(3 * mesh.triangles.size());
  std::vector<Index> next(at.first.begin(), at.first.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t]) at.items[next[v]++] = static_cast<Index>(t);
  return at;
}

}  // namespace

MeshTopology mesh_topology(const TriangleMesh& mesh) {
  MeshTopology topology;
  topology.original = along_curve(mesh);
  topology.mesh = reordered(mesh, topology.original);
  find_edges(topology);
  topology.triangles_at = triangles_at_vertices(topology.mesh);
  return topology;
}

}  // namespace scree
