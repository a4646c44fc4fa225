#include "mesh/mesh_features.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

// Concave edges below this sine are kept: they may be flat but for round-off, and then are convex from one
// side.
constexpr Real kFlatSine = 1e-9;

class FeatureFinder {
 public:
  FeatureFinder(const MeshTopology& topology, const MeshParts& parts, bool sheet)
      : topology_(topology),
        parts_(parts),
        sheet_(sheet),
        touched_(topology.mesh.vertices.size(), false),
        open_(touched_) {}

  MeshFeatures find() {
    for (const MeshEdge& edge : topology_.edges) {
      if (may_touch(edge)) touched_[edge.low] = touched_[edge.high] = true;
      if (!topology_.joins_two(edge)) open_[edge.low] = open_[edge.high] = true;
    }
    for (Index t = 0; t < static_cast<Index>(topology_.mesh.triangles.size()); ++t) add_triangle(t);
    return std::move(result_);
  }

 private:
  const MeshPart& part(Index triangle) const { return parts_.parts[parts_.part_of[triangle]]; }

  bool is_inner(const MeshEdge& edge) const {
    if (!topology_.joins_two(edge)) return false;
    const auto uses = topology_.uses_of(edge);
    return parts_.part_of[uses[0].triangle] == parts_.part_of[uses[1].triangle];
  }

  bool may_touch(const MeshEdge& edge) const {
    if (is_inner(edge)) return false;
    return sheet_ || !topology_.joins_two(edge) || !is_concave(edge);
  }

  // Whether the second face rises above the first.
  bool is_concave(const MeshEdge& edge) const {
    const auto uses = topology_.uses_of(edge);
    const Vec3 along = topology_.mesh.vertices[edge.high] - topology_.mesh.vertices[edge.low];
    const Vec3 left = cross(part(uses[1].triangle).normal, along);
    const Real rise = dot(left, part(uses[0].triangle).normal) / norm(along);
    return (uses[1].reversed ? -rise : rise) > kFlatSine;
  }

  void add_triangle(Index t) {
    const auto& vertex = topology_.mesh.triangles[t];
    MeshTriangle triangle{{vertex[0], vertex[1], vertex[2]},
                          parts_.part_of[t],
                          0,
                          static_cast<Index>(result_.features.size()),
                          0};
    for (int k = 0; k < 3; ++k) {
      const MeshEdge& edge = topology_.edges[topology_.edges_of[t][k]];
      if (is_inner(edge)) triangle.flags |= kInnerEdge << k;
      if (vertex[k] != edge.low) triangle.flags |= kReversed << k;
      if (topology_.uses_of(edge)[0].triangle != t || !may_touch(edge)) continue;
      triangle.flags |= kOwnsEdge << k;
      add_edge(edge);
    }
    for (int k = 0; k < 3; ++k) {
      if (!touched_[vertex[k]] || topology_.triangles_at.of(vertex[k])[0] != t) continue;
      triangle.flags |= kOwnsVertex << k;
      add_vertex(vertex[k]);
    }
    triangle.features = static_cast<Index>(result_.features.size()) - triangle.first_feature;
    result_.triangles.push_back(triangle);
  }

  void add_edge(const MeshEdge& edge) {
    std::vector<Index> tests, patches;
    Vec3 outward;
    for (const EdgeUse& use : topology_.uses_of(edge)) {
      const Index id = parts_.part_of[use.triangle];
      tests.push_back(use.reversed ? ~id : id);
      patches.push_back(parts_.parts[id].patch);
      outward += parts_.parts[id].normal;
    }
    // The number of tests distinguishes edges of two faces from others. Where the two faces have opposite
    // windings there are no sides either, and the first face is tested twice.
    if (edge.uses == 2 && !topology_.joins_two(edge)) tests.push_back(tests.front());
    add(edge.low, edge.high, tests, patches, outward, tests.front() < 0 ? ~tests.front() : tests.front());
  }

  void add_vertex(Index v) {
    std::vector<Index> tests, patches;
    Vec3 outward;
    for (const Index t : topology_.triangles_at.of(v)) {
      const auto& vertex = topology_.mesh.triangles[t];
      const int k = static_cast<int>(std::find(vertex.begin(), vertex.end(), v) - vertex.begin());
      const Index next = vertex[(k + 1) % 3], last = vertex[(k + 2) % 3];
      tests.insert(tests.end(), {next, last});
      patches.push_back(part(t).patch);
      outward += angle_at(v, next, last) * part(t).normal;
    }
    make_unique(tests);
    add(v, open_[v] ? kOpenVertex : kVertex, tests, patches, outward,
        parts_.part_of[topology_.triangles_at.of(v)[0]]);
  }

  Real angle_at(Index v, Index next, Index last) const {
    const auto& vertices = topology_.mesh.vertices;
    const Vec3 a = vertices[next] - vertices[v], b = vertices[last] - vertices[v];
    return std::atan2(norm(cross(a, b)), dot(a, b));
  }

  static void make_unique(std::vector<Index>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  }

  // other: a part whose normal is used where the normals of all faces cancel.
  void add(Index a, Index b, const std::vector<Index>& tests, std::vector<Index>& patches, Vec3 outward,
           Index other) {
    make_unique(patches);
    const Real length = norm(outward);
    const Vec3 unit = length > 1e-6 ? unit_normal(outward) : parts_.parts[other].normal;
    result_.features.push_back({a, b, static_cast<Index>(result_.tests.size()),
                                static_cast<Index>(tests.size()), static_cast<Index>(result_.patches.size()),
                                static_cast<Index>(patches.size()), in_single(unit)});
    result_.tests.insert(result_.tests.end(), tests.begin(), tests.end());
    result_.patches.insert(result_.patches.end(), patches.begin(), patches.end());
  }

  const MeshTopology& topology_;
  const MeshParts& parts_;
  bool sheet_;
  std::vector<bool> touched_, open_;  // vertices
  MeshFeatures result_;
};

}  // namespace

MeshFeatures mesh_features(const MeshTopology& topology, const MeshParts& parts, bool sheet) {
  return FeatureFinder(topology, parts, sheet).find();
}

}  // namespace scree
