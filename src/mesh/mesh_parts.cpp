#include "mesh/mesh_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace scree {

namespace {

// Largest number of plane fits while a part grows.
constexpr int kMostFits = 8;
// Edges whose angle equals the feature angle but for round-off do not join patches: a drum of twelve facets
// has twelve edges at 30 degrees.
constexpr Real kAngleRoundOff = 1e-9;

Vec3 area_vector(const TriangleMesh& mesh, Index t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
}

// Collects parts one after the other.
class PartFinder {
 public:
  PartFinder(const MeshTopology& topology, Real flatness)
      : topology_(topology), flatness_(flatness), part_of_(topology.mesh.triangles.size(), -1) {}

  // Starts from the largest triangles, whose planes are the most accurate.
  MeshParts find() {
    std::vector<std::pair<Real, Index>> seeds;
    for (Index t = 0; t < static_cast<Index>(part_of_.size()); ++t)
      seeds.emplace_back(-norm(area_vector(topology_.mesh, t)), t);
    std::sort(seeds.begin(), seeds.end());
    for (const auto& [area, t] : seeds)
      if (part_of_[t] < 0) grow(t);
    return numbered_by_triangle();
  }

 private:
  // A larger part has a more accurate plane: slivers at its far end may fit only then.
  void grow(Index seed) {
    const Index id = static_cast<Index>(parts_.size());
    std::vector<Index> members{seed};
    part_of_[seed] = id;
    MeshPart part{topology_.mesh.vertices[topology_.mesh.triangles[seed][0]],
                  unit_normal(area_vector(topology_.mesh, seed)), -1};
    for (int fit = 0; fit < kMostFits; ++fit) {
      const std::size_t before = members.size();
      for (std::size_t i = 0; i < members.size(); ++i) add_neighbours(members[i], id, part, members);
      if (members.size() == before) break;
      part.normal = unit_normal(area_inside_border(members, part.point));
    }
    parts_.push_back(part);
  }

  void add_neighbours(Index t, Index id, const MeshPart& part, std::vector<Index>& members) {
    for (const Index e : topology_.edges_of[t]) {
      const MeshEdge& edge = topology_.edges[e];
      if (!topology_.joins_two(edge)) continue;
      const Index other = topology_.across(edge, t);
      if (part_of_[other] >= 0 || !lies_in(part, other)) continue;
      part_of_[other] = id;
      members.push_back(other);
    }
  }

  // Only the sign of a sliver's normal is used.
  bool lies_in(const MeshPart& part, Index t) const {
    Real size = 0;
    for (const Index v : topology_.mesh.triangles[t]) {
      const Vec3 d = topology_.mesh.vertices[v] - part.point;
      if (!(std::abs(dot(d, part.normal)) <= flatness_)) return false;
      size = std::max(
          size, norm(topology_.mesh.vertices[v] - topology_.mesh.vertices[topology_.mesh.triangles[t][0]]));
    }
    return dot(area_vector(topology_.mesh, t), part.normal) > -flatness_ * size;
  }

  // Twice the vector area enclosed by the members' outer edges, exactly 0 along an axis across which they do
  // not extend.
  Vec3 area_inside_border(const std::vector<Index>& members, Vec3 point) const {
    Vec3 area;
    for (const Index t : members)
      for (int k = 0; k < 3; ++k) {
        const MeshEdge& edge = topology_.edges[topology_.edges_of[t][k]];
        if (topology_.joins_two(edge) && part_of_[topology_.across(edge, t)] == part_of_[t]) continue;
        const auto& triangle = topology_.mesh.triangles[t];
        area += cross(topology_.mesh.vertices[triangle[k]] - point,
                      topology_.mesh.vertices[triangle[(k + 1) % 3]] - point);
      }
    return area;
  }

  MeshParts numbered_by_triangle() const {
    MeshParts result;
    std::vector<Index> number(parts_.size(), -1);
    for (const Index part : part_of_) {
      if (number[part] < 0) {
        number[part] = static_cast<Index>(result.parts.size());
        result.parts.push_back(parts_[part]);
      }
      result.part_of.push_back(number[part]);
    }
    return result;
  }

  const MeshTopology& topology_;
  Real flatness_;
  std::vector<Index> part_of_;
  std::vector<MeshPart> parts_;
};

// Disjoint sets of numbers with union by pairs; the root of a set is its lowest number.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

void find_patches(const MeshTopology& topology, Real cosine, MeshParts& result) {
  JoinedSets sets(result.parts.size());
  for (const MeshEdge& edge : topology.edges) {
    if (!topology.joins_two(edge)) continue;
    const auto uses = topology.uses_of(edge);
    const Index a = result.part_of[uses[0].triangle], b = result.part_of[uses[1].triangle];
    if (dot(result.parts[a].normal, result.parts[b].normal) > cosine + kAngleRoundOff) sets.join(a, b);
  }
  Index patches = 0;
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    const Index root = sets.root(static_cast<Index>(p));
    result.parts[p].patch = root == static_cast<Index>(p) ? patches++ : result.parts[root].patch;
  }
  result.neighbours.first.assign(patches + 1, 0);
}

void find_neighbours(const MeshTopology& topology, MeshParts& result) {
  std::vector<std::pair<Index, Index>> pairs;
  const auto patch = [&](const EdgeUse& use) { return result.parts[result.part_of[use.triangle]].patch; };
  for (const MeshEdge& edge : topology.edges)
    for (const EdgeUse& a : topology.uses_of(edge))
      for (const EdgeUse& b : topology.uses_of(edge))
        if (patch(a) != patch(b)) pairs.emplace_back(patch(a), patch(b));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  IndexLists& lists = result.neighbours;
  for (const auto& [one, other] : pairs) {
    ++lists.first[one + 1];
    lists.items.push_back(other);
  }
  std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
}

}  // namespace

Vec3 unit_normal(Vec3 normal) {
  const Real length = norm(normal);
  return {0 + normal.x / length, 0 + normal.y / length, 0 + normal.z / length};
}

MeshParts mesh_parts(const MeshTopology& topology, Real flatness, Real cosine) {
  MeshParts result = PartFinder(topology, flatness).find();
  find_patches(topology, cosine, result);
  find_neighbours(topology, result);
  return result;
}

}  // namespace scree
