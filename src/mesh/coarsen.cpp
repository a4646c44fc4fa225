#include "mesh/coarsen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/mesh_tree.hpp"

namespace scree {
namespace {

// Least height of a new triangle over its longest edge.
constexpr Real kSliver = 0.02;
constexpr Index kNone = -1;

using Corners = std::array<Index, 3>;

std::pair<Index, Index> edge_of(Index a, Index b) { return std::minmax(a, b); }

// Vertices sorted by coordinates; triangles start at their lowest vertex and are sorted by their vertices.
TriangleMesh in_own_order(const TriangleMesh& mesh) {
  std::vector<Index> order(mesh.vertices.size()), number(order.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index v) {
    const Vec3 p = mesh.vertices[v];
    return std::tuple(p.x, p.y, p.z);
  });
  TriangleMesh result;
  for (const Index v : order) {
    number[v] = static_cast<Index>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
  }
  for (Corners t : mesh.triangles) {
    for (Index& v : t) v = number[v];
    std::ranges::rotate(t, std::ranges::min_element(t));
    result.triangles.push_back(t);
  }
  std::ranges::sort(result.triangles);
  return result;
}

// The sum of areas times squared distances from planes n.x = d.
struct Quadric {
  Sym3 square;
  Vec3 linear;
  Real constant = 0;

  void add(Real weight, Vec3 normal, Real distance) {
    square += outer(weight, normal);
    linear += weight * distance * normal;
    constant += weight * distance * distance;
  }
  Quadric& operator+=(const Quadric& other) {
    square += other.square, linear += other.linear, constant += other.constant;
    return *this;
  }
  Real at(Vec3 p) const { return std::max(Real(0), dot(p, square * p) - 2 * dot(linear, p) + constant); }
};

// A possible edge collapse, of one vertex into another one.
struct Collapse {
  Real cost, length;  // [m^4], squared [m^2]
  Index gone, kept;
  int age_gone, age_kept;  // of the two vertices when the collapse was queued
  // The cheapest collapse comes first in the queue.
  bool operator<(const Collapse& other) const {
    return std::tie(cost, length, gone, kept) > std::tie(other.cost, other.length, other.gone, other.kept);
  }
};

class Coarsener {
 public:
  Coarsener(const TriangleMesh& mesh, Real distance, Real cosine)
      : vertices_(mesh.vertices),
        distance_(distance),
        cosine_(cosine),
        triangles_(mesh.triangles),
        at_(vertices_.size()),
        near_(triangles_.size()),
        quadrics_(vertices_.size()),
        moved_(vertices_.size()),
        age_(vertices_.size()),
        refused_(vertices_.size()),
        middle_(middle_of(mesh)) {
    for (Index t = 0; t < static_cast<Index>(triangles_.size()); ++t)
      for (const Index v : triangles_[t]) at_[v].push_back(t);
    add_planes();
    find_borders();
  }

  CoarseMesh mesh() {
    for (Index v = 0; v < static_cast<Index>(vertices_.size()); ++v) think_of(v);
    while (!queue_.empty()) {
      const Collapse next = queue_.top();
      queue_.pop();
      if (next.age_gone != age_[next.gone] || next.age_kept != age_[next.kept]) continue;
      if (!collapse(next.gone, next.kept)) refused_[next.gone] = true;
    }
    return remaining();
  }

 private:
  // The changes that a collapse would make.
  struct Change {
    std::vector<Index> changed, gone;              // triangles
    std::vector<std::pair<Index, Index>> of_near;  // removed vertices and the triangle nearest to each
    std::vector<Real> distances;                   // of these vertices
    std::vector<Index> of_border;                  // those on the removed border edge
  };

  static Vec3 middle_of(const TriangleMesh& mesh) {
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3 v : mesh.vertices) {
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    return Real(0.5) * (low + high);
  }
  Vec3 area_normal(const Corners& t) const {
    const Vec3 a = vertices_[t[0]];
    return cross(vertices_[t[1]] - a, vertices_[t[2]] - a);
  }
  static bool has(const Corners& t, Index v) { return t[0] == v || t[1] == v || t[2] == v; }
  Corners moved(Corners t, Index from, Index to) const {
    std::ranges::replace(t, from, to);
    return t;
  }
  std::vector<Index> neighbours(Index v) const {
    std::vector<Index> around;
    for (const Index t : at_[v])
      for (const Index w : triangles_[t])
        if (w != v) around.push_back(w);
    std::ranges::sort(around);
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
  }
  bool is_border(Index a, Index b) const { return on_border_.contains(edge_of(a, b)); }

  void add_planes() {
    for (const Corners& t : triangles_) {
      const Vec3 normal = area_normal(t), unit = (1 / norm(normal)) * normal;
      for (const Index v : t) quadrics_[v].add(norm(normal) / 2, unit, dot(unit, vertices_[t[0]] - middle_));
    }
  }

  // Finds free edges, sharp edges and edges with more than two triangles, and the vertices that must stay.
  void find_borders() {
    std::map<std::pair<Index, Index>, std::vector<Index>> edges;
    for (Index t = 0; t < static_cast<Index>(triangles_.size()); ++t)
      for (int k = 0; k < 3; ++k) edges[edge_of(triangles_[t][k], triangles_[t][(k + 1) % 3])].push_back(t);
    borders_at_.resize(vertices_.size());
    for (const auto& [edge, uses] : edges) {
      if (uses.size() == 2 && is_smooth(area_normal(triangles_[uses[0]]), area_normal(triangles_[uses[1]])))
        continue;
      on_border_[edge];
      ++borders_at_[edge.first], ++borders_at_[edge.second];
    }
  }
  bool is_smooth(Vec3 n, Vec3 m) const { return dot(n, m) > cosine_ * norm(n) * norm(m); }

  void think_of(Index gone) {
    refused_[gone] = false;
    if (borders_at_[gone] != 0 && borders_at_[gone] != 2) return;
    for (const Index kept : neighbours(gone)) think_of(gone, kept);
  }
  void think_of(Index gone, Index kept) {
    if (borders_at_[gone] == 2 && !is_border(gone, kept)) return;
    if (borders_at_[gone] != 0 && borders_at_[gone] != 2) return;
    Quadric both = quadrics_[gone];
    both += quadrics_[kept];
    const Vec3 apart = vertices_[kept] - vertices_[gone];
    queue_.push({both.at(vertices_[kept] - middle_), dot(apart, apart), gone, kept, age_[gone], age_[kept]});
  }

  // The vertex at the other end of the border that continues from `kept` beyond `gone`.
  Index border_beyond(Index gone, Index kept) const {
    for (const Index w : neighbours(gone))
      if (w != kept && is_border(gone, w)) return w;
    return kNone;
  }

  bool collapse(Index gone, Index kept) {
    Change change;
    for (const Index t : at_[gone]) (has(triangles_[t], kept) ? change.gone : change.changed).push_back(t);
    if (!keeps_topology(gone, kept, change) || !keeps_shape(gone, kept, change)) return false;
    const Index beyond = borders_at_[gone] == 2 ? border_beyond(gone, kept) : kNone;
    if (beyond != kNone && !keeps_border(gone, kept, beyond, change)) return false;
    if (!keeps_near(gone, kept, change)) return false;
    apply(gone, kept, beyond, change);
    return true;
  }

  // Whether the only common neighbours of both vertices are the third corners of the triangles between them,
  // and no triangle comes to lie on another one.
  bool keeps_topology(Index gone, Index kept, const Change& change) const {
    const std::vector<Index> a = neighbours(gone), b = neighbours(kept);
    std::vector<Index> common;
    std::ranges::set_intersection(a, b, std::back_inserter(common));
    if (common.size() != change.gone.size() || change.changed.empty()) return false;
    const auto sorted = [](Corners t) {
      std::ranges::sort(t);
      return t;
    };
    for (const Index t : change.changed)
      for (const Index other : at_[kept])
        if (sorted(moved(triangles_[t], gone, kept)) == sorted(triangles_[other])) return false;
    return true;
  }

  // Height over the longest edge; 0 of a degenerate triangle.
  Real slenderness(const Corners& t) const {
    Real longest = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = vertices_[t[(k + 1) % 3]] - vertices_[t[k]];
      longest = std::max(longest, dot(edge, edge));
    }
    return norm(area_normal(t)) / longest;
  }
  bool keeps_shape(Index gone, Index kept, const Change& change) const {
    return std::ranges::all_of(change.changed, [&](Index t) {
      const Corners now = moved(triangles_[t], gone, kept);
      const Real shape = slenderness(now);
      return shape > 0 && shape >= std::min(kSliver, slenderness(triangles_[t])) &&
             is_smooth(area_normal(now), area_normal(triangles_[t])) && stays_smooth(t, now, gone, kept);
    });
  }
  // Whether no edge of a changed triangle becomes sharp.
  bool stays_smooth(Index t, const Corners& now, Index gone, Index kept) const {
    for (int k = 0; k < 3; ++k) {
      const Index a = now[k], b = now[(k + 1) % 3];
      if (is_border(triangles_[t][k], triangles_[t][(k + 1) % 3]) || is_border(a, b)) continue;
      for (const Index other : at_[a == kept ? b : a])
        if (other != t && !is_smooth_to(now, a, b, other, gone, kept)) return false;
    }
    return true;
  }
  bool is_smooth_to(const Corners& now, Index a, Index b, Index other, Index gone, Index kept) const {
    if (has(triangles_[other], gone) && has(triangles_[other], kept)) return true;  // is removed
    const Corners neighbour = moved(triangles_[other], gone, kept);
    return !has(neighbour, a) || !has(neighbour, b) || is_smooth(area_normal(now), area_normal(neighbour));
  }

  // Whether the border, which then runs from `beyond` to `kept`, stays near all vertices that it contained.
  bool keeps_border(Index gone, Index kept, Index beyond, Change& change) const {
    const std::vector<Index> around = neighbours(beyond);
    if (std::ranges::binary_search(around, kept)) return false;
    for (const auto& edge : {edge_of(gone, kept), edge_of(gone, beyond)})
      change.of_border.insert(change.of_border.end(), on_border_.at(edge).begin(), on_border_.at(edge).end());
    change.of_border.push_back(gone);
    return std::ranges::all_of(change.of_border, [&](Index v) {
      return squared_distance(vertices_[kept], vertices_[beyond], vertices_[v]) <= distance_ * distance_;
    });
  }

  bool keeps_near(Index gone, Index kept, Change& change) const {
    std::vector<Index> away;
    if (borders_at_[gone] == 0) away.push_back(gone);
    for (const Index t : at_[gone]) away.insert(away.end(), near_[t].begin(), near_[t].end());
    for (const Index v : away) {
      Real nearest = kInfinity;
      Index triangle = kNone;
      for (const Index t : change.changed) {
        const Corners now = moved(triangles_[t], gone, kept);
        const Real far =
            squared_distance(vertices_[now[0]], vertices_[now[1]], vertices_[now[2]], vertices_[v]);
        if (far < nearest) nearest = far, triangle = t;
      }
      if (!(nearest <= distance_ * distance_)) return false;
      change.of_near.emplace_back(v, triangle);
      change.distances.push_back(std::sqrt(nearest));
    }
    return true;
  }

  void apply(Index gone, Index kept, Index beyond, const Change& change) {
    for (const Index t : at_[gone]) near_[t].clear();
    for (const Index t : change.gone) {
      for (const Index v : triangles_[t])
        if (v != gone) std::erase(at_[v], t);
      triangles_[t] = {kNone, kNone, kNone};
    }
    for (const Index t : change.changed) {
      triangles_[t] = moved(triangles_[t], gone, kept);
      at_[kept].push_back(t);
    }
    std::ranges::sort(at_[kept]);
    at_[gone].clear();
    for (std::size_t k = 0; k < change.of_near.size(); ++k) {
      const auto [v, t] = change.of_near[k];
      near_[t].push_back(v);
      moved_[v] = change.distances[k];
    }
    if (beyond != kNone) move_border(gone, kept, beyond, change);
    quadrics_[kept] += quadrics_[gone];
    ++age_[gone], ++age_[kept];
    for (const Index v : neighbours(kept)) {
      think_of(kept, v), think_of(v, kept);
      if (refused_[v]) think_of(v);
    }
  }
  void move_border(Index gone, Index kept, Index beyond, const Change& change) {
    on_border_.erase(edge_of(gone, kept)), on_border_.erase(edge_of(gone, beyond));
    on_border_[edge_of(beyond, kept)] = change.of_border;
    for (const Index v : change.of_border)
      moved_[v] = std::sqrt(squared_distance(vertices_[kept], vertices_[beyond], vertices_[v]));
  }

  CoarseMesh remaining() const {
    CoarseMesh result;
    std::vector<Index> number(vertices_.size(), kNone);
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      if (at_[v].empty()) continue;
      number[v] = static_cast<Index>(result.mesh.vertices.size());
      result.mesh.vertices.push_back(vertices_[v]);
    }
    for (const Corners& t : triangles_)
      if (t[0] != kNone) result.mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    for (const Real far : moved_) result.moved = std::max(result.moved, far);
    return result;
  }

  const std::vector<Vec3>& vertices_;
  Real distance_, cosine_;
  std::vector<Corners> triangles_;        // kNone where they are removed
  std::vector<std::vector<Index>> at_;    // triangles at each vertex, increasing
  std::vector<std::vector<Index>> near_;  // for each triangle, the removed vertices nearest to it
  std::map<std::pair<Index, Index>, std::vector<Index>>
      on_border_;                // for each edge, the vertices collapsed along it
  std::vector<int> borders_at_;  // number of these edges at a vertex
  std::vector<Quadric> quadrics_;
  std::vector<Real> moved_;  // [m]
  std::vector<int> age_;
  std::vector<char> refused_;  // whether a collapse of this vertex was refused
  Vec3 middle_;
  std::priority_queue<Collapse> queue_;
};

}  // namespace

CoarseMesh coarsened(const TriangleMesh& mesh, Real distance, Real feature_angle) {
  const TriangleMesh ordered = in_own_order(mesh);
  return Coarsener(ordered, distance, std::cos(feature_angle)).mesh();
}

}  // namespace scree
