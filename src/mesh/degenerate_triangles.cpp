#include "mesh/degenerate_triangles.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace scree {

namespace {

// Height over the longest side; length of a side, below which its ends are merged.
constexpr Real kLeastHeight = 1e-12;
constexpr Index kRemoved = -1;

using Corners = std::array<Index, 3>;
using Edge = std::pair<Index, Index>;  // the lower vertex first

bool has(const Corners& t, Index v) { return t[0] == v || t[1] == v || t[2] == v; }
bool has_corner_twice(const Corners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

class Joiner {
 public:
  explicit Joiner(NumberedMesh& mesh)
      : vertices_(mesh.mesh.vertices),
        triangles_(mesh.mesh.triangles),
        numbers_(mesh.numbers),
        at_(vertices_.size()) {
    for (Index t = 0; t < static_cast<Index>(triangles_.size()); ++t)
      for (const Index v : triangles_[t])
        if (at_[v].empty() || at_[v].back() != t) at_[v].push_back(t);
  }

  void leave_out() {
    // The split of a triangle that is hardly higher than the removed ones may leave another degenerate one.
    constexpr int kMostRounds = 20;
    for (int round = 0; round < kMostRounds; ++round) {
      merge_needles();
      const std::vector<Index> found = without_area();
      if (found.empty()) break;
      for (const std::vector<Index>& row : rows_of(found)) join_across(row);
    }
    drop_gone();
  }

 private:
  std::vector<Index> without_area() const {
    std::vector<Index> found;
    for (Index t = 0; t < static_cast<Index>(triangles_.size()); ++t)
      if (triangles_[t][0] != kRemoved && !is_high(triangles_[t])) found.push_back(t);
    return found;
  }
  bool is_high(const Corners& t) const {
    return has_area({vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]});
  }

  void remove(Index t) {
    for (const Index v : triangles_[t]) std::erase(at_[v], t);
    triangles_[t] = {kRemoved, kRemoved, kRemoved};
  }
  void put(Index t, const Corners& corners) {
    triangles_[t] = corners;
    for (const Index v : corners)
      if (std::ranges::find(at_[v], t) == at_[v].end()) at_[v].push_back(t);
  }

  // Merges coincident corners of needles; triangles with a repeated corner are then removed.
  void merge_needles() {
    std::vector<Index> found = without_area();
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Index t = found[i];
      if (triangles_[t][0] == kRemoved) continue;
      const Corners c = triangles_[t];
      if (has_corner_twice(c)) {
        remove(t);
        continue;
      }
      std::array<Real, 3> length{};  // of the side that starts at corner k [m]
      for (int k = 0; k < 3; ++k) length[k] = norm(vertices_[c[(k + 1) % 3]] - vertices_[c[k]]);
      const auto k = static_cast<int>(std::ranges::min_element(length) - length.begin());
      if (!(length[k] <= kLeastHeight * std::ranges::max(length))) continue;
      const std::vector<Index> around = at_[c[k]];
      merge(c[(k + 1) % 3], c[k]);
      found.insert(found.end(), around.begin(), around.end());
    }
  }
  // Afterwards no triangle uses the removed vertex.
  void merge(Index kept, Index gone) {
    const std::vector<Index> around = std::move(at_[gone]);
    at_[gone].clear();
    for (const Index t : around) {
      Corners corners = triangles_[t];
      std::ranges::replace(corners, gone, kept);
      put(t, corners);
    }
  }

  // Groups of triangles that are connected over edges, and so lie on one line.
  std::vector<std::vector<Index>> rows_of(const std::vector<Index>& found) const {
    std::map<Edge, std::vector<Index>> at_edge;
    for (const Index t : found)
      for (const Edge& edge : edges_of(triangles_[t])) at_edge[edge].push_back(t);
    std::vector<std::vector<Index>> rows;
    std::set<Index> seen;
    for (const Index first : found) {
      if (!seen.insert(first).second) continue;
      std::vector<Index> row{first};
      for (std::size_t i = 0; i < row.size(); ++i)
        for (const Edge& edge : edges_of(triangles_[row[i]]))
          for (const Index other : at_edge.at(edge))
            if (seen.insert(other).second) row.push_back(other);
      rows.push_back(std::move(row));
    }
    return rows;
  }
  static std::array<Edge, 3> edges_of(const Corners& t) {
    return {std::minmax(t[0], t[1]), std::minmax(t[1], t[2]), std::minmax(t[2], t[0])};
  }

  // Removes the row and splits all triangles at its edges at all its points there: every piece of the line
  // then has as many triangles as there are over and under it.
  void join_across(const std::vector<Index>& row) {
    std::set<Edge> edges;
    std::vector<Index> points;
    for (const Index t : row) {
      for (const Edge& edge : edges_of(triangles_[t])) edges.insert(edge);
      points.insert(points.end(), triangles_[t].begin(), triangles_[t].end());
      remove(t);
    }
    const auto length = [&](const Edge& e) { return norm(vertices_[e.second] - vertices_[e.first]); };
    const Edge longest = *std::ranges::max_element(edges, {}, length);
    const Vec3 along = vertices_[longest.second] - vertices_[longest.first];
    const auto along_line = [&](Index v) {
      return std::pair(dot(along, vertices_[v] - vertices_[longest.first]), v);
    };
    std::ranges::sort(points, {}, along_line);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (auto [a, b] : edges) {
      if (along_line(b) < along_line(a)) std::swap(a, b);
      const auto first = std::ranges::upper_bound(points, along_line(a), {}, along_line),
                 last = std::ranges::lower_bound(points, along_line(b), {}, along_line);
      std::vector<Index> between;
      std::copy_if(first, last, std::back_inserter(between), [&, a = a, b = b](Index v) {
        return !is_high({a, v, b});
      });
      if (!between.empty()) split_at(a, b, between);
    }
  }

  // Splits all triangles at the edge from a to b at the points between them, in order from a.
  void split_at(Index a, Index b, const std::vector<Index>& between) {
    const std::vector<Index> around = at_[a];
    for (const Index t : around) {
      if (!has(triangles_[t], b)) continue;
      const Corners whole = triangles_[t];
      const auto part = [&](Index from, Index to) {
        Corners corners = whole;
        for (Index& v : corners) v = v == a ? from : v == b ? to : v;
        return corners;
      };
      std::erase(at_[b], t);
      put(t, part(a, between.front()));
      for (std::size_t k = 0; k < between.size(); ++k) {
        triangles_.push_back({kRemoved, kRemoved, kRemoved});
        numbers_.push_back(numbers_[t]);
        put(static_cast<Index>(triangles_.size()) - 1,
            part(between[k], k + 1 < between.size() ? between[k + 1] : b));
      }
    }
  }

  void drop_gone() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t][0] == kRemoved) continue;
      triangles_[kept] = triangles_[t], numbers_[kept++] = numbers_[t];
    }
    triangles_.resize(kept), numbers_.resize(kept);
  }

  const std::vector<Vec3>& vertices_;
  std::vector<Corners>& triangles_;
  std::vector<Index>& numbers_;
  std::vector<std::vector<Index>> at_;  // triangles at each vertex, each once
};

}  // namespace

bool has_area(const TriangleCorners& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const Real longest2 = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
  return norm(cross(ab, ca)) > kLeastHeight * longest2;
}

std::vector<Index> remove_degenerate(NumberedMesh& mesh) {
  std::vector<Index> numbers;
  for (Index t = 0; t < static_cast<Index>(mesh.mesh.triangles.size()); ++t)
    if (!has_area(corners_of(mesh.mesh, t))) numbers.push_back(mesh.numbers[t]);
  if (!numbers.empty()) Joiner(mesh).leave_out();
  return numbers;
}

}  // namespace scree
