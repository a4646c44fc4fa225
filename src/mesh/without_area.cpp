#include "mesh/without_area.hpp"

#include <algorithm>
#include <array>
#include <deque>

namespace scree {

namespace {

constexpr Real kLeastHeight = 1e-12;  // over the longest side, and of a side over the longest
constexpr Index kGone = -1;

using Corners = std::array<Index, 3>;

bool has(const Corners& t, Index v) { return t[0] == v || t[1] == v || t[2] == v; }
bool has_corner_twice(const Corners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

Real squared_length(Vec3 a) { return dot(a, a); }

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

  // waiting: the triangles without area. Each is left out once; a split can make others, of shorter sides.
  void leave_out(std::deque<Index> waiting) {
    constexpr std::size_t kMostPerTriangle = 100;  // far more than any row of slivers needs
    std::size_t left = kMostPerTriangle * waiting.size();
    for (; !waiting.empty() && left > 0; --left) {
      const Index t = waiting.front();
      waiting.pop_front();
      if (triangles_[t][0] == kGone || has_area_now(t)) continue;
      if (has_corner_twice(triangles_[t])) {
        remove(t);
      } else {
        join_across(t);
      }
      waiting.insert(waiting.end(), made_.begin(), made_.end());
      made_.clear();
    }
    drop_gone();
  }

 private:
  bool has_area_now(Index t) const {
    const auto [a, b, c] = triangles_[t];
    return has_area({vertices_[a], vertices_[b], vertices_[c]});
  }
  void note(Index t) {
    if (!has_area_now(t)) made_.push_back(t);
  }

  void remove(Index t) {
    for (const Index v : triangles_[t]) std::erase(at_[v], t);
    triangles_[t] = {kGone, kGone, kGone};
  }

  // t has three corners on one line.
  void join_across(Index t) {
    const Corners c = triangles_[t];
    std::array<Real, 3> length{};  // squared, of the side from corner k on [m^2]
    for (int k = 0; k < 3; ++k) length[k] = squared_length(vertices_[c[(k + 1) % 3]] - vertices_[c[k]]);
    const auto longest = static_cast<int>(std::ranges::max_element(length) - length.begin());
    const auto shortest = static_cast<int>(std::ranges::min_element(length) - length.begin());
    if (length[shortest] <= kLeastHeight * kLeastHeight * length[longest]) {
      merge(std::min(c[shortest], c[(shortest + 1) % 3]), std::max(c[shortest], c[(shortest + 1) % 3]));
      return;
    }
    remove(t);
    split_edge(c[longest], c[(longest + 1) % 3], c[(longest + 2) % 3]);
  }

  // All triangles at the edge from a to b are split at m.
  void split_edge(Index a, Index b, Index m) {
    const std::vector<Index> around = at_[a];
    for (const Index t : around) {
      if (!has(triangles_[t], b)) continue;
      Corners near_a = triangles_[t], near_b = triangles_[t];
      std::ranges::replace(near_a, b, m);
      std::ranges::replace(near_b, a, m);
      std::erase(at_[b], t);
      put(t, near_a);
      triangles_.push_back({kGone, kGone, kGone});
      numbers_.push_back(numbers_[t]);
      put(static_cast<Index>(triangles_.size()) - 1, near_b);
    }
  }
  void put(Index t, const Corners& corners) {
    triangles_[t] = corners;
    for (const Index v : corners)
      if (std::ranges::find(at_[v], t) == at_[v].end()) at_[v].push_back(t);
    note(t);
  }

  void merge(Index kept, Index gone) {
    const std::vector<Index> around = std::move(at_[gone]);
    at_[gone].clear();
    for (const Index t : around) {
      Corners corners = triangles_[t];
      std::ranges::replace(corners, gone, kept);
      put(t, corners);
    }
  }

  void drop_gone() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t][0] == kGone) continue;
      triangles_[kept] = triangles_[t], numbers_[kept++] = numbers_[t];
    }
    triangles_.resize(kept), numbers_.resize(kept);
  }

  const std::vector<Vec3>& vertices_;
  std::vector<Corners>& triangles_;
  std::vector<Index>& numbers_;
  std::vector<std::vector<Index>> at_;  // triangles at each vertex, each once
  std::vector<Index> made_;             // without area, by the last step
};

}  // namespace

bool has_area(const TriangleCorners& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const Real longest2 = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
  return norm(cross(ab, ca)) > kLeastHeight * longest2;
}

std::vector<Index> leave_out_without_area(NumberedMesh& mesh) {
  std::deque<Index> found;
  std::vector<Index> numbers;
  for (Index t = 0; t < static_cast<Index>(mesh.mesh.triangles.size()); ++t) {
    if (has_area(corners_of(mesh.mesh, t))) continue;
    found.push_back(t);
    numbers.push_back(mesh.numbers[t]);
  }
  if (found.empty()) return {};
  Joiner(mesh).leave_out(std::move(found));
  return numbers;
}

}  // namespace scree
