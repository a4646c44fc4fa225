#include "mesh/weld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace scree {

namespace {

// Bit patterns order all values, including NaN; adding 0 makes -0 a +0.
using Bits = std::array<std::uint64_t, 3>;
Vec3 without_minus_zero(Vec3 v) { return {v.x + 0, v.y + 0, v.z + 0}; }
Bits bits_of(Vec3 v) {
  return {std::bit_cast<std::uint64_t>(v.x), std::bit_cast<std::uint64_t>(v.y),
          std::bit_cast<std::uint64_t>(v.z)};
}

// For each vertex the lowest number of the vertices with its coordinates.
std::vector<Index> first_equal(const std::vector<Vec3>& vertices) {
  struct Entry {
    Bits bits;
    Index vertex;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  entries.reserve(vertices.size());
  for (const Vec3 v : vertices) entries.push_back({bits_of(v), static_cast<Index>(entries.size())});
  std::sort(entries.begin(), entries.end());
  std::vector<Index> equal(vertices.size());
  for (std::size_t i = 0, first = 0; i < entries.size(); ++i) {
    if (entries[i].bits != entries[first].bits) first = i;
    equal[entries[i].vertex] = entries[first].vertex;
  }
  return equal;
}

// Points in cells as wide as the search distance.
class NearPoints {
 public:
  NearPoints(const std::vector<Vec3>& points, Real distance) : points_(points), distance_(distance) {}
  void add(Index point) { cells_[bits_of(cell_of(points_[point], {}))].push_back(point); }
  // The lowest of the added points within the distance; -1: none.
  Index first_near(Vec3 v) const {
    Index first = -1;
    for (int k = 0; k < 27; ++k) {
      const Vec3 step{Real(k % 3 - 1), Real(k / 3 % 3 - 1), Real(k / 9 - 1)};
      const auto cell = cells_.find(bits_of(cell_of(v, step)));
      if (cell == cells_.end()) continue;
      for (const Index point : cell->second)
        if (norm(points_[point] - v) <= distance_ && (first < 0 || point < first)) first = point;
    }
    return first;
  }

 private:
  struct Hash {
    std::size_t operator()(const Bits& b) const {
      std::uint64_t hash = 0;
      for (const std::uint64_t word : b) hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
      return hash;
    }
  };
  // Real: cells at any distance are representable.
  Vec3 cell_of(Vec3 v, Vec3 step) const {
    return without_minus_zero({std::floor(v.x / distance_) + step.x, std::floor(v.y / distance_) + step.y,
                               std::floor(v.z / distance_) + step.z});
  }

  const std::vector<Vec3>& points_;
  Real distance_;
  std::unordered_map<Bits, std::vector<Index>, Hash> cells_;
};

}  // namespace

TriangleMesh welded(const TriangleMesh& mesh) {
  std::vector<Vec3> vertices(mesh.vertices.size());
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), vertices.begin(), without_minus_zero);
  const std::vector<Index> equal = first_equal(vertices);
  TriangleMesh result;
  result.triangles.reserve(mesh.triangles.size());
  std::vector<Index> number(vertices.size(), -1);
  for (std::array<Index, 3> triangle : mesh.triangles) {
    for (Index& corner : triangle) {
      corner = equal[corner];
      if (number[corner] < 0) {
        number[corner] = static_cast<Index>(result.vertices.size());
        result.vertices.push_back(vertices[corner]);
      }
      corner = number[corner];
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

NumberedMesh numbered(TriangleMesh mesh) {
  std::vector<Index> numbers(mesh.triangles.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return {std::move(mesh), std::move(numbers)};
}

NumberedMesh welded_within(const TriangleMesh& mesh, Real tolerance) {
  TriangleMesh exact = welded(mesh);
  std::vector<Index> kept(exact.vertices.size());
  NearPoints points(exact.vertices, tolerance);
  for (Index i = 0; i < static_cast<Index>(kept.size()); ++i) {
    kept[i] = points.first_near(exact.vertices[i]);
    if (kept[i] < 0) points.add(kept[i] = i);
  }
  const auto shrunk = [](const std::array<Index, 3>& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  };
  NumberedMesh result;
  std::vector<std::array<Index, 3>> triangles;
  for (Index i = 0; i < static_cast<Index>(exact.triangles.size()); ++i) {
    std::array<Index, 3> triangle = exact.triangles[i];
    for (Index& corner : triangle) corner = kept[corner];
    if (shrunk(triangle) && !shrunk(exact.triangles[i])) continue;
    triangles.push_back(triangle);
    result.numbers.push_back(i);
  }
  exact.triangles = std::move(triangles);
  result.mesh = welded(exact);
  return result;
}

}  // namespace scree
