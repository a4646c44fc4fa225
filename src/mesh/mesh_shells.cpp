#include "mesh/mesh_shells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "mesh/mesh_sides.hpp"

namespace scree {

namespace {

constexpr std::size_t kMostShells = 10'000;  // each is compared with each

struct Shell {
  std::vector<std::array<Vec3, 3>> triangles;
  Vec3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};  // of its box

  void add(const std::array<Vec3, 3>& triangle) {
    triangles.push_back(triangle);
    for (const Vec3 v : triangle) {
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
  }
  bool may_hold(Vec3 p) const {
    return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z && p.z <= high.z;
  }
  Vec3 place() const { return triangles[0][0]; }
  Real volume() const {
    Real sum = 0;
    for (const auto& [a, b, c] : triangles) sum += dot(a - place(), cross(b - place(), c - place()));
    return sum / 6;
  }
};

// The solid angle of a triangle seen from a point, over 4 pi, above 0 from its back; no number on it: van
// Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983.
Real turns_around(Vec3 point, Vec3 a, Vec3 b, Vec3 c) {
  a -= point, b -= point, c -= point;
  const Real la = norm(a), lb = norm(b), lc = norm(c);
  const Real up = dot(a, cross(b, c)), down = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  constexpr Real kOnIt = 1e-9;  // of a right angle's three edges
  if (down <= 0 && std::abs(up) <= kOnIt * la * lb * lc) return std::numeric_limits<Real>::quiet_NaN();
  return std::atan2(up, down) / (2 * std::numbers::pi_v<Real>);
}

// How often the shell goes around the point: 1 inside, 0 outside.
Real turns_around(Vec3 point, const Shell& shell) {
  Real turns = 0;
  if (shell.may_hold(point))
    for (const auto& [a, b, c] : shell.triangles) turns += turns_around(point, a, b, c);
  return turns;
}

}  // namespace

std::vector<Index> shells_of(const TriangleMesh& mesh) {
  std::vector<Index> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Index i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for_each_edge(sides_of(mesh), [&](const Side* first, const Side* last) {
    for (const Side* side = first + 1; side < last; ++side) {
      const Index a = root(first->triangle), b = root(side->triangle);
      parent[std::max(a, b)] = std::min(a, b);
    }
  });
  std::vector<Index> shell(parent.size());
  Index count = 0;
  for (Index i = 0; i < static_cast<Index>(parent.size()); ++i) {
    const Index first = root(i);  // the lowest of its piece, at most i
    shell[i] = first == i ? count++ : shell[first];
  }
  return shell;
}

std::vector<MisplacedShell> misplaced_shells(const TriangleMesh& mesh,
                                             const std::vector<Index>& shell_of_triangle) {
  const Index count = 1 + *std::max_element(shell_of_triangle.begin(), shell_of_triangle.end());
  if (count == 1 || static_cast<std::size_t>(count) > kMostShells) return {};
  std::vector<Shell> shells(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    shells[shell_of_triangle[i]].add({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  }
  std::vector<MisplacedShell> misplaced;
  for (Index i = 0; i < count; ++i) {
    Real turns = 0;
    for (Index j = 0; j < count; ++j)
      if (j != i) turns += turns_around(shells[i].place(), shells[j]);
    const Real volume = shells[i].volume(), whole = std::round(turns);
    const bool touches = !(std::abs(turns - whole) < Real(0.01));
    if (!touches && whole != (volume < 0 ? 1 : 0)) misplaced.push_back({i, volume});
  }
  return misplaced;
}

}  // namespace scree
