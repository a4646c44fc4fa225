#include "mesh/mesh_fold.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {
namespace {

const Real kSharp = std::cos(std::numbers::pi_v<Real> / 6);  // smallest angle of a fold: 30 degrees
constexpr Real kAlike = 1e-9;  // angles that differ by less are equal but for round-off [rad]

// The corner of a triangle that is not on the edge.
Vec3 corner_off(const MeshTopology& topology, Index triangle, const MeshEdge& edge) {
  for (const Index v : topology.mesh.triangles[triangle])
    if (v != edge.low && v != edge.high) return topology.mesh.vertices[v];
  return topology.mesh.vertices[edge.low];
}

}  // namespace

MeshFold least_fold(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet) {
  MeshFold least;
  for (const MeshEdge& edge : topology.edges) {
    if (!topology.joins_two(edge)) continue;
    const auto uses = topology.uses_of(edge);
    const Index one = parts.part_of[uses[0].triangle], other = parts.part_of[uses[1].triangle];
    const Vec3 n = parts.parts[one].normal, m = parts.parts[other].normal;
    if (one == other || dot(n, m) > std::min(cosine, kSharp)) continue;
    const Vec3 a = topology.mesh.vertices[edge.low], b = topology.mesh.vertices[edge.high];
    if (!sheet && !(dot(corner_off(topology, uses[1].triangle, edge) - a, n) > 0)) continue;
    const Real angle = std::atan2(norm(cross(n, m)), dot(n, m));
    if (least.angle == 0 || angle < least.angle - kAlike) least = {angle, Real(0.5) * (a + b)};
  }
  return least;
}

}  // namespace scree
