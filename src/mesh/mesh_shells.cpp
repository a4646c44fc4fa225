#include "mesh/mesh_shells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "mesh/box_tree.hpp"
#include "mesh/mesh_sides.hpp"
#include "mesh/shell_crossings.hpp"

namespace scree {

namespace {

constexpr std::size_t kMostShells = 10'000;  // all pairs are compared
// Fraction of the thickness: a point so deep under the surface of a shell is inside it.
constexpr Real kThicknessFraction = 0.01;

// Normal of a triangle, of length 2 x area.
Vec3 normal_of(const TriangleCorners& c) { return cross(c[1] - c[0], c[2] - c[0]); }

struct Shell {
  std::vector<std::array<Vec3, 3>> triangles;
  Vec3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};  // corners of its box

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
  Real volume() const {
    const Vec3 origin = triangles[0][0];
    Real sum = 0;
    for (const auto& [a, b, c] : triangles) sum += dot(a - origin, cross(b - origin, c - origin));
    return sum / 6;
  }
  Real area() const {
    Real sum = 0;
    for (const auto& [a, b, c] : triangles) sum += norm(cross(b - a, c - a));
    return sum / 2;
  }
};

// The solid angle of a triangle seen from a point, over 4 pi, positive from its back; exactly on the
// triangle it is no number: van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983.
Real winding_number(Vec3 point, Vec3 a, Vec3 b, Vec3 c) {
  a -= point, b -= point, c -= point;
  const Real la = norm(a), lb = norm(b), lc = norm(c);
  const Real up = dot(a, cross(b, c)), down = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  constexpr Real kOnIt = 1e-9;  // relative to the product of the distances
  if (down <= 0 && std::abs(up) <= kOnIt * la * lb * lc) return std::numeric_limits<Real>::quiet_NaN();
  return std::atan2(up, down) / (2 * std::numbers::pi_v<Real>);
}

// Winding number of the shell about the point: 1 inside, 0 outside.
Real winding_number(Vec3 point, const Shell& shell) {
  Real winding = 0;
  if (shell.may_hold(point))
    for (const auto& [a, b, c] : shell.triangles) winding += winding_number(point, a, b, c);
  return winding;
}

// Number of points at which the surroundings of a shell are tested: each costs a pass over the triangles of
// the shells whose boxes contain it, and one over all boxes.
std::size_t points_to_test(std::size_t triangles, std::size_t shells) {
  constexpr Real kMostPoints = 16, kMostTriangles = 1e7, kMostBoxes = 1e8;
  const Real many = std::min(kMostTriangles / static_cast<Real>(triangles),
                             kMostBoxes / static_cast<Real>(shells * shells));
  return static_cast<std::size_t>(std::clamp(many, Real(1), kMostPoints));
}

// The largest triangle of each part of a list that is cut into so many parts.
std::vector<Index> largest_of_parts(const TriangleMesh& mesh, const std::vector<Index>& list,
                                    std::size_t parts) {
  std::vector<Index> largest;
  for (std::size_t k = 0; k < std::min(parts, list.size()); ++k) {
    const auto at = [&](std::size_t part) {
      return list.begin() + static_cast<std::ptrdiff_t>(part * list.size() / std::min(parts, list.size()));
    };
    largest.push_back(*std::max_element(at(k), at(k + 1), [&](Index t, Index u) {
      return norm(normal_of(corners_of(mesh, t))) < norm(normal_of(corners_of(mesh, u)));
    }));
  }
  return largest;
}

// The point at this depth under the centre of a triangle [m].
Vec3 behind(const TriangleMesh& mesh, Index triangle, Real depth) {
  const TriangleCorners c = corners_of(mesh, triangle);
  const Vec3 normal = normal_of(c);
  return Real(1) / 3 * (c[0] + c[1] + c[2]) - depth / norm(normal) * normal;
}

std::vector<Shell> pieces_of(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle) {
  std::vector<Shell> shells(1 + static_cast<std::size_t>(*std::ranges::max_element(shell_of_triangle)));
  for (Index t = 0; t < static_cast<Index>(mesh.triangles.size()); ++t)
    shells[shell_of_triangle[t]].add(corners_of(mesh, t));
  return shells;
}

// A depth at which a point is certainly under the surface of a shell [m], at most `depth`.
Real depth_under(const Shell& shell, Real depth) {
  return std::min(depth, kThicknessFraction * std::abs(shell.volume()) / shell.area());
}

// Whether the shell has most of the points inside.
bool encloses(const Shell& shell, const std::vector<Vec3>& points) {
  const auto inside =
      std::ranges::count_if(points, [&](Vec3 p) { return std::abs(winding_number(p, shell)) > Real(0.5); });
  return 2 * inside > std::ssize(points);
}

}  // namespace

std::vector<Real> shell_volumes(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle) {
  std::vector<Real> volumes;
  for (const Shell& shell : pieces_of(mesh, shell_of_triangle)) volumes.push_back(shell.volume());
  return volumes;
}

ShellNesting shell_nesting(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle) {
  constexpr std::size_t kMostPoints = 5;
  const std::vector<Shell> shells = pieces_of(mesh, shell_of_triangle);
  const std::size_t count = shells.size();
  ShellNesting nesting{{}, std::vector<std::vector<Index>>(count)};
  for (const Shell& shell : shells) nesting.volume.push_back(shell.volume());
  if (count == 1 || count > kMostShells) return nesting;
  std::vector<std::vector<Index>> triangles(count);
  for (Index t = 0; t < static_cast<Index>(shell_of_triangle.size()); ++t)
    triangles[shell_of_triangle[t]].push_back(t);
  const Real depth = kCrossingTolerance * extent_of(boxes_of(mesh));
  const std::size_t most = std::min(kMostPoints, points_to_test(mesh.triangles.size(), count));
  for (std::size_t i = 0; i < count; ++i) {
    const Real under = depth_under(shells[i], depth);
    std::vector<Vec3> points;
    for (const Index t : largest_of_parts(mesh, triangles[i], most))
      points.push_back(behind(mesh, t, nesting.volume[i] < 0 ? -under : under));
    // A smaller shell that touches it from inside does not enclose it.
    const auto size = [&](std::size_t k) { return std::pair(std::abs(nesting.volume[k]), count - k); };
    for (std::size_t j = 0; j < count; ++j)
      if (size(j) > size(i) && encloses(shells[j], points))
        nesting.around[i].push_back(static_cast<Index>(j));
  }
  return nesting;
}

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
                                             const std::vector<Index>& shell_of_triangle,
                                             const std::vector<Index>& crossing) {
  const Index count = 1 + *std::max_element(shell_of_triangle.begin(), shell_of_triangle.end());
  if (count == 1 || static_cast<std::size_t>(count) > kMostShells) return {};
  const std::vector<Shell> shells = pieces_of(mesh, shell_of_triangle);
  const std::vector<MeshBox> boxes = boxes_of(mesh);
  std::vector<std::vector<Index>> near(shells.size());
  for (const Index t : triangles_near_others(boxes, shell_of_triangle))
    near[shell_of_triangle[t]].push_back(t);
  const Real depth = kCrossingTolerance * extent_of(boxes);
  const std::size_t points = points_to_test(mesh.triangles.size(), shells.size());
  std::vector<Real> volume;
  for (const Shell& shell : shells) volume.push_back(shell.volume());
  std::set<Index> misplaced;
  for (Index i = 0; i < count; ++i) {
    if (std::ranges::binary_search(crossing, i)) continue;
    // Winding number that the other shells must have in the solid behind the shell.
    const Real around = volume[i] < 0 ? 1 : 0;
    if (near[i].empty() && around != 0) misplaced.insert(i);
    const Real under = depth_under(shells[i], depth);
    for (const Index t : largest_of_parts(mesh, near[i], points)) {
      Real winding = 0;
      Index smallest = i;  // of two solids that share a volume
      for (Index j = 0; j < count; ++j) {
        const Real of_other = j == i ? 0 : winding_number(behind(mesh, t, under), shells[j]);
        winding += of_other;
        if (of_other > Real(0.5) && volume[j] < volume[smallest]) smallest = j;
      }
      const bool is_known = std::abs(winding - std::round(winding)) < Real(0.01);
      if (is_known && std::round(winding) != around) misplaced.insert(smallest);
    }
  }
  std::vector<MisplacedShell> result;
  for (const Index shell : misplaced) result.push_back({shell, volume[shell]});
  return result;
}

}  // namespace scree
