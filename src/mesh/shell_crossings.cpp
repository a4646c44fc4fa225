#include "mesh/shell_crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "mesh/box_tree.hpp"

namespace scree {

namespace {

using Corners = TriangleCorners;

// The intersection of a triangle with a plane: its range along `direction`, and its ends [m]. height: of the
// triangle's corners over the plane.
struct Cut {
  Real low = kInfinity, high = -kInfinity;
  Vec3 at_low, at_high;

  void add(Vec3 p, Vec3 direction) {
    const Real t = dot(p, direction);
    if (t < low) low = t, at_low = p;
    if (t > high) high = t, at_high = p;
  }
};

Cut cut_of(const Corners& corners, const std::array<Real, 3>& height, Vec3 direction) {
  Cut cut;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    if (height[k] == 0) cut.add(corners[k], direction);
    if ((height[k] < 0 && height[l] > 0) || (height[k] > 0 && height[l] < 0))
      cut.add(corners[k] + height[k] / (height[k] - height[l]) * (corners[l] - corners[k]), direction);
  }
  return cut;
}

// The middle of the segment that two triangles have in common, where they intersect by more than the
// tolerance [m].
std::optional<Vec3> crossing_of(const Corners& a, const Corners& b, Real tolerance) {
  const auto unit_normal = [](const Corners& t) {
    const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
    return (1 / norm(n)) * n;
  };
  const Vec3 normal_a = unit_normal(a), normal_b = unit_normal(b);
  const auto heights = [](const Corners& of, const Corners& over, Vec3 normal) {
    return std::array{dot(of[0] - over[0], normal), dot(of[1] - over[0], normal),
                      dot(of[2] - over[0], normal)};
  };
  const auto is_on_both_sides = [&](const std::array<Real, 3>& height) {
    const auto [least, most] = std::ranges::minmax(height);
    return least < -tolerance && most > tolerance;
  };
  const std::array<Real, 3> over_b = heights(a, b, normal_b), over_a = heights(b, a, normal_a);
  if (!is_on_both_sides(over_b) || !is_on_both_sides(over_a)) return std::nullopt;
  const Vec3 line = cross(normal_a, normal_b);
  const Vec3 direction = (1 / norm(line)) * line;
  const Cut of_a = cut_of(a, over_b, direction), of_b = cut_of(b, over_a, direction);
  if (!(std::min(of_a.high, of_b.high) - std::max(of_a.low, of_b.low) > tolerance)) return std::nullopt;
  const Vec3 first = of_a.low > of_b.low ? of_a.at_low : of_b.at_low,
             last = of_a.high < of_b.high ? of_a.at_high : of_b.at_high;
  return Real(0.5) * (first + last);
}

}  // namespace

std::vector<ShellCrossing> shell_crossings(const TriangleMesh& mesh,
                                           const std::vector<Index>& shell_of_triangle) {
  const Index shells = 1 + *std::ranges::max_element(shell_of_triangle);
  if (shells == 1) return {};
  const auto corners = [&](Index t) { return corners_of(mesh, t); };
  const std::vector<MeshBox> boxes = boxes_of(mesh);
  const Real tolerance = kCrossingTolerance * extent_of(boxes);
  const std::vector<Index> near = triangles_near_others(boxes, shell_of_triangle);
  std::vector<MeshBox> near_boxes;
  for (const Index t : near) near_boxes.push_back(boxes[t]);
  const BoxTree tree(near_boxes);
  std::map<std::pair<Index, Index>, ShellCrossing> found;
  for (const Index t : near)
    tree.for_each_at(boxes[t], [&](Index k) {
      const Index u = near[k], one = shell_of_triangle[t], other = shell_of_triangle[u];
      if (one >= other) return;
      const auto known = found.find({one, other});
      if (known != found.end() &&
          std::pair(known->second.triangle[0], known->second.triangle[1]) <= std::pair(t, u))
        return;
      if (const std::optional<Vec3> p = crossing_of(corners(t), corners(u), tolerance))
        found[{one, other}] = {{one, other}, {t, u}, *p};
    });
  std::vector<ShellCrossing> crossings;
  for (const auto& [shells_of_two, crossing] : found) crossings.push_back(crossing);
  return crossings;
}

std::optional<OwnCrossing> own_crossing(const TriangleMesh& mesh) {
  const std::vector<MeshBox> boxes = boxes_of(mesh);
  const Real tolerance = kCrossingTolerance * extent_of(boxes);
  const BoxTree tree(boxes);
  const auto adjoin = [&](Index t, Index u) {
    return std::ranges::any_of(mesh.triangles[t], [&](Index v) {
      return std::ranges::find(mesh.triangles[u], v) != mesh.triangles[u].end();
    });
  };
  for (Index t = 0; t < static_cast<Index>(boxes.size()); ++t) {
    std::optional<OwnCrossing> first;
    tree.for_each_at(boxes[t], [&](Index u) {
      if (u <= t || (first && first->triangle[1] < u) || adjoin(t, u)) return;
      if (const std::optional<Vec3> p = crossing_of(corners_of(mesh, t), corners_of(mesh, u), tolerance))
        first = {{t, u}, *p};
    });
    if (first) return first;
  }
  return std::nullopt;
}

std::vector<Index> crossing_shells(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle) {
  std::set<Index> shells;
  for (const ShellCrossing& c : shell_crossings(mesh, shell_of_triangle))
    shells.insert({c.shell[0], c.shell[1]});
  return {shells.begin(), shells.end()};
}

}  // namespace scree
