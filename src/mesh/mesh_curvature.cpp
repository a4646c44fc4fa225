#include "mesh/mesh_curvature.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

// A sag of less, over the extent of the mesh, may be of coordinates with 7 digits: slivers of a plane that
// such a file bends are no curves. Circles of more than some 2000 facets are not judged for this.
constexpr Real kLeastSag = 1e-6;

// Of each part [m].
std::vector<Vec3> centroids(const MeshTopology& topology, const MeshParts& parts) {
  std::vector<Vec3> sum(parts.parts.size());
  std::vector<Real> area(parts.parts.size());
  for (std::size_t t = 0; t < topology.mesh.triangles.size(); ++t) {
    const auto& v = topology.mesh.triangles[t];
    const Vec3 a = topology.mesh.vertices[v[0]], b = topology.mesh.vertices[v[1]],
               c = topology.mesh.vertices[v[2]];
    const Real weight = norm(cross(b - a, c - a));
    const Index part = parts.part_of[t];
    sum[part] +=
        weight / 3 *
        ((a - parts.parts[part].point) + (b - parts.parts[part].point) + (c - parts.parts[part].point));
    area[part] += weight;
  }
  for (std::size_t p = 0; p < sum.size(); ++p)
    sum[p] = parts.parts[p].point + (area[p] > 0 ? 1 / area[p] : 0) * sum[p];
  return sum;
}

Real distance_from_line(Vec3 p, Vec3 a, Vec3 b) { return norm(cross(p - a, b - a)) / norm(b - a); }

}  // namespace

MeshCurvature mesh_curvature(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet) {
  const std::vector<Vec3> middle = centroids(topology, parts);
  const std::vector<Vec3>& vertices = topology.mesh.vertices;
  Vec3 low = vertices.front(), high = low;
  for (const Vec3 v : vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const Real least_sag = kLeastSag * norm(high - low);
  MeshCurvature result;
  for (const MeshEdge& edge : topology.edges) {
    if (!topology.joins_two(edge)) continue;
    const auto uses = topology.uses_of(edge);
    const Index one = parts.part_of[uses[0].triangle], other = parts.part_of[uses[1].triangle];
    const Vec3 n = parts.parts[one].normal, m = parts.parts[other].normal;
    if (one == other || !(dot(n, m) > cosine)) continue;
    const Real turn = std::atan2(norm(cross(n, m)), dot(n, m));
    const Vec3 a = vertices[edge.low], b = vertices[edge.high];
    const Real near = distance_from_line(middle[one], a, b), far = distance_from_line(middle[other], a, b);
    const Real sag = 2 * std::min(near, far) * turn / 8;
    if (!(sag > least_sag)) continue;
    result.sag = std::max(result.sag, sag);
    if (sheet || dot(middle[other] - a, n) > 0)
      result.concave_radius = std::min(result.concave_radius, (near + far) / turn);
  }
  return result;
}

}  // namespace scree
