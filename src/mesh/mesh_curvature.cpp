#include "mesh/mesh_curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/mat3.hpp"

namespace scree {
namespace {

// A sag below this fraction of the mesh's extent may come from coordinates with 7 digits: slivers of a plane
// that is bent by such a file are not curved. Circles of more than some 2000 facets are not detected for
// this reason.
constexpr Real kLeastSag = 1e-6;
// Smallest ratio of the next bend of a curve to the present one: the ratio is 1 between the facets of a
// cylinder, a half between equilateral triangles, a third in the twisted faces of a screw.
constexpr Real kLeastContinuation = 0.2;

struct PartShape {
  Vec3 middle;  // centroid [m]
  Real area = 0;
};

std::vector<PartShape> shapes_of(const MeshTopology& topology, const MeshParts& parts) {
  std::vector<PartShape> shapes(parts.parts.size());
  for (std::size_t t = 0; t < topology.mesh.triangles.size(); ++t) {
    const auto& v = topology.mesh.triangles[t];
    const Vec3 a = topology.mesh.vertices[v[0]], b = topology.mesh.vertices[v[1]],
               c = topology.mesh.vertices[v[2]], origin = parts.parts[parts.part_of[t]].point;
    PartShape& shape = shapes[parts.part_of[t]];
    const Real area = norm(cross(b - a, c - a)) / 2;
    shape.middle += area / 3 * ((a - origin) + (b - origin) + (c - origin));
    shape.area += area;
  }
  for (std::size_t p = 0; p < shapes.size(); ++p)
    shapes[p].middle =
        parts.parts[p].point + (shapes[p].area > 0 ? 1 / shapes[p].area : 0) * shapes[p].middle;
  return shapes;
}

Real distance_from_line(Vec3 p, Vec3 a, Vec3 b) { return norm(cross(p - a, b - a)) / norm(b - a); }

// An edge at which a smooth patch bends from part `one` to part `other`.
struct Bend {
  Index one, other, low, high;  // parts; vertices of the edge
  Real angle, length;           // [rad], [m]
  bool concave;                 // seen from outside
  Vec3 axis;                    // along the edge
  Real border = 0;              // length of all edges between the two parts [m]
};

std::pair<Index, Index> parts_of(const Bend& bend) { return std::minmax({bend.one, bend.other}); }

void set_borders(std::vector<Bend>& bends) {
  std::ranges::stable_sort(bends, {}, parts_of);
  for (std::size_t first = 0, last = 0; first < bends.size(); first = last) {
    Real border = 0;
    for (; last < bends.size() && parts_of(bends[last]) == parts_of(bends[first]); ++last)
      border += bends[last].length;
    for (std::size_t t = first; t < last; ++t) bends[t].border = border;
  }
}

std::vector<Bend> smooth_bends(const MeshTopology& topology, const MeshParts& parts,
                               const std::vector<PartShape>& shapes, Real cosine) {
  std::vector<Bend> bends;
  for (const MeshEdge& edge : topology.edges) {
    if (!topology.joins_two(edge)) continue;
    const auto uses = topology.uses_of(edge);
    const Index one = parts.part_of[uses[0].triangle], other = parts.part_of[uses[1].triangle];
    const Vec3 n = parts.parts[one].normal, m = parts.parts[other].normal;
    if (one == other || !(dot(n, m) > cosine)) continue;
    const Vec3 a = topology.mesh.vertices[edge.low], along = topology.mesh.vertices[edge.high] - a;
    const Real angle = std::atan2(norm(cross(n, m)), dot(n, m)), length = norm(along);
    bends.push_back({one, other, edge.low, edge.high, angle, length, dot(shapes[other].middle - a, n) > 0,
                     (1 / length) * along});
  }
  set_borders(bends);
  return bends;
}

// Bending of a patch at the borders of one part, about any direction: sums of angle, length and the square
// of the edge's direction.
struct Bending {
  Sym3 all, convex;  // all: concave bends with their sign; convex: with concave bends subtracted [rad m]
};

std::vector<Bending> bendings_of(const std::vector<Bend>& bends, std::size_t parts) {
  std::vector<Bending> bendings(parts);
  for (const Bend& bend : bends)
    for (const Index part : {bend.one, bend.other}) {
      const Real weight = bend.angle * bend.length;
      bendings[part].all += outer(weight, bend.axis);
      bendings[part].convex += outer(bend.concave ? -weight : weight, bend.axis);
    }
  return bendings;
}

Real about(const Sym3& bending, Vec3 axis) { return dot(axis, bending * axis); }

// Whether a bend belongs to a curve: the patch bends at the other borders of both parts, about the same or
// an oblique direction. Otherwise the edge is a crease, of a plane or of a much flatter curve.
bool is_of_curve(const Bend& bend, const Bending& one, const Bending& other) {
  const Real here = bend.angle * bend.border;
  return std::min(about(one.all, bend.axis), about(other.all, bend.axis)) >= (1 + kLeastContinuation) * here;
}

}  // namespace

MeshCurvature mesh_curvature(const MeshTopology& topology, const MeshParts& parts, Real cosine, bool sheet) {
  const std::vector<Vec3>& vertices = topology.mesh.vertices;
  Vec3 low = vertices.front(), high = low;
  for (const Vec3 v : vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const Real least_sag = kLeastSag * norm(high - low);
  const std::vector<PartShape> shapes = shapes_of(topology, parts);
  const std::vector<Bend> bends = smooth_bends(topology, parts, shapes, cosine);
  const std::vector<Bending> bendings = bendings_of(bends, shapes.size());
  MeshCurvature result;
  for (const Bend& bend : bends) {
    const PartShape &one = shapes[bend.one], &other = shapes[bend.other];
    const Bending &here = bendings[bend.one], &there = bendings[bend.other];
    if (!is_of_curve(bend, here, there)) continue;
    // The border of the two parts counts half for each of them.
    Sym3 convex = here.convex;
    convex += there.convex;
    const Real share = 1 / (2 * (one.area + other.area)),
               curvature = share * std::abs(about(convex, bend.axis));
    const Vec3 a = vertices[bend.low], b = vertices[bend.high];
    const Real width =
        2 * std::min(distance_from_line(one.middle, a, b), distance_from_line(other.middle, a, b));
    const Real sag = curvature * width * width / 8;
    if (!(sag > least_sag)) continue;
    result.sag = std::max(result.sag, sag);
    const std::array<Real, 3> principal = principal_values(convex);
    const Real concave = share * std::max(-principal.front(), sheet ? principal.back() : 0);
    if (concave * width * width / 8 > least_sag)
      result.concave_radius = std::min(result.concave_radius, 1 / concave);
  }
  return result;
}

}  // namespace scree
