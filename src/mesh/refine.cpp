#include "mesh/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <queue>
#include <unordered_map>
#include <vector>

#include "base/error.hpp"
#include "mesh/mesh_mass.hpp"

namespace scree {

namespace {

// Priority in the queue: the longest edge first, of equal ones that with the lowest vertices.
struct Edge {
  Real length;
  Index low, high;
  bool operator<(const Edge& other) const {
    if (length != other.length) return length < other.length;
    return low != other.low ? low > other.low : high > other.high;
  }
};

class Refiner {
 public:
  Refiner(const TriangleMesh& mesh, Real edge_length, Index most_triangles)
      : mesh_(mesh), edge_length_(edge_length), most_(most_triangles) {
    for (Index i = 0; i < static_cast<Index>(mesh_.triangles.size()); ++i) {
      const auto [a, b, c] = mesh_.triangles[i];
      parent_.push_back(i);
      add_edge(a, b, i), add_edge(b, c, i), add_edge(c, a, i);
    }
  }

  TriangleMesh mesh() {
    // A triangle with such edges has at most the area of an equilateral one.
    const Real largest = std::sqrt(Real(3)) / 4 * edge_length_ * edge_length_;
    if (!(mesh_area(mesh_) <= most_ * largest)) fail();
    while (!queue_.empty()) {
      const Edge edge = queue_.top();
      queue_.pop();
      split(edge.low, edge.high);
    }
    return in_order();
  }

 private:
  static std::uint64_t key(Index a, Index b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
  }
  // Queues the edge to be split, starting with its first triangle.
  void add_edge(Index a, Index b, Index triangle) {
    const Real length = norm(mesh_.vertices[a] - mesh_.vertices[b]);
    if (!(length > edge_length_)) return;
    std::vector<Index>& around = around_[key(a, b)];
    if (around.empty()) queue_.push({length, std::min(a, b), std::max(a, b)});
    around.push_back(triangle);
  }
  void split(Index a, Index b) {
    const std::vector<Index> around = std::move(around_.extract(key(a, b)).mapped());
    const Index middle = static_cast<Index>(mesh_.vertices.size());
    mesh_.vertices.push_back(Real(0.5) * (mesh_.vertices[a] + mesh_.vertices[b]));
    for (const Index triangle : around) halve(triangle, a, b, middle);
  }
  // Splits a triangle at its edge between a and b; a precedes b in the triangle.
  void halve(Index triangle, Index a, Index b, Index middle) {
    std::array<Index, 3> corners = mesh_.triangles[triangle];
    while (corners[0] == a || corners[0] == b)
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    const auto [tip, first, second] = corners;
    if (static_cast<Index>(mesh_.triangles.size()) >= most_) fail();
    const Index half = static_cast<Index>(mesh_.triangles.size());
    mesh_.triangles[triangle] = {tip, first, middle};
    mesh_.triangles.push_back({tip, middle, second});
    parent_.push_back(parent_[triangle]);
    const auto other = around_.find(key(second, tip));
    if (other != around_.end()) std::replace(other->second.begin(), other->second.end(), triangle, half);
    add_edge(first, middle, triangle), add_edge(middle, second, half);
    add_edge(tip, middle, triangle), add_edge(tip, middle, half);
  }
  // Triangles in the order of their parents, then of their creation.
  TriangleMesh in_order() {
    std::vector<Index> order(parent_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return parent_[i] < parent_[j]; });
    TriangleMesh result{std::move(mesh_.vertices), {}};
    result.triangles.reserve(order.size());
    for (const Index i : order) result.triangles.push_back(mesh_.triangles[i]);
    return result;
  }
  [[noreturn]] void fail() const {
    throw InputError(
        fmt::format("edges of at most {:.6g} m would make more than {} triangles", edge_length_, most_));
  }

  TriangleMesh mesh_;
  Real edge_length_;
  Index most_;
  std::vector<Index> parent_;  // per triangle, its triangle of the original mesh
  std::unordered_map<std::uint64_t, std::vector<Index>> around_;  // triangles at the queued edges
  std::priority_queue<Edge> queue_;
};

}  // namespace

TriangleMesh refined(const TriangleMesh& mesh, Real edge_length, Index most_triangles) {
  return Refiner(mesh, edge_length, most_triangles).mesh();
}

}  // namespace scree
