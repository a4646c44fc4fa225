#include "mesh/polygon.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

namespace scree {

namespace {

constexpr Index kMostNotConvex = 1000;  // the time for all ears grows as the cube

struct Flat {
  Real x, y;
};

// Twice the area of a triangle, positive where it runs counterclockwise.
Real area2(Flat a, Flat b, Flat c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Twice the vector area of the polygon (Newell).
Vec3 span_of(const std::vector<Vec3>& points) {
  Vec3 span;
  for (std::size_t k = 1; k + 1 < points.size(); ++k)
    span += cross(points[k] - points[0], points[k + 1] - points[0]);
  return span;
}

// Projection along the axis nearest to the polygon's normal, so that it runs counterclockwise.
std::vector<Flat> flattened(const std::vector<Vec3>& points) {
  const Vec3 span = span_of(points);
  const Real x = std::abs(span.x), y = std::abs(span.y), z = std::abs(span.z);
  std::vector<Flat> flat;
  for (const Vec3 p : points) {
    if (z >= x && z >= y) {
      flat.push_back(span.z < 0 ? Flat{p.y, p.x} : Flat{p.x, p.y});
    } else if (x >= y) {
      flat.push_back(span.x < 0 ? Flat{p.z, p.y} : Flat{p.y, p.z});
    } else {
      flat.push_back(span.y < 0 ? Flat{p.x, p.z} : Flat{p.z, p.x});
    }
  }
  return flat;
}

// Whether all corners bend to the left, once around.
bool is_convex(const std::vector<Flat>& points) {
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n; ++k)
    if (!(area2(points[k], points[(k + 1) % n], points[(k + 2) % n]) > 0)) return false;
  for (std::size_t k = 1; k + 1 < n; ++k)
    if (!(area2(points[0], points[k], points[k + 1]) > 0)) return false;
  return true;
}

// Whether two sides cross; they may touch, as in polygons with a hole, where outline and hole are joined.
bool crosses_itself(const std::vector<Flat>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Flat a = points[i], b = points[(i + 1) % n];
    for (std::size_t j = i + 1; j < n; ++j) {
      const Flat c = points[j], d = points[(j + 1) % n];
      if (area2(a, b, c) * area2(a, b, d) < 0 && area2(c, d, a) * area2(c, d, b) < 0) return true;
    }
  }
  return false;
}

// Whether the corner at position k can be cut off: it bends to the left and its triangle contains no other
// corner.
bool is_ear(const std::vector<Flat>& points, const std::vector<Index>& left, std::size_t k) {
  const std::size_t n = left.size();
  const Index before = left[(k + n - 1) % n], tip = left[k], after = left[(k + 1) % n];
  const Flat a = points[before], b = points[tip], c = points[after];
  if (!(area2(a, b, c) > 0)) return false;
  for (const Index other : left) {
    const Flat p = points[other];
    const auto is = [&](Flat corner) { return p.x == corner.x && p.y == corner.y; };
    if (other == before || other == tip || other == after || is(a) || is(b) || is(c)) continue;
    if (area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::string add_polygon(TriangleMesh& mesh, const std::vector<Index>& corners) {
  const auto add = [&](Index a, Index b, Index c) {
    mesh.triangles.push_back({corners[a], corners[b], corners[c]});
  };
  const Index size = static_cast<Index>(corners.size());
  std::vector<Vec3> points;
  for (const Index corner : corners) points.push_back(mesh.vertices[corner]);
  const std::vector<Flat> flat = flattened(points);
  if (size == 3 || is_convex(flat)) {
    for (Index k = 1; k + 1 < size; ++k) add(0, k, k + 1);
    return "";
  }
  if (size > kMostNotConvex)
    return fmt::format("{} corners and not convex; must be at most {} then", size, kMostNotConvex);
  const std::string crossed = "it crosses itself or has no area";
  if (crosses_itself(flat)) return crossed;
  std::vector<Index> left(corners.size());
  std::iota(left.begin(), left.end(), 0);
  const std::size_t before = mesh.triangles.size();
  for (std::size_t k = 0, tried = 0; left.size() > 2; ++k) {
    const std::size_t n = left.size();
    k %= n;
    if (is_ear(flat, left, k)) {
      add(left[(k + n - 1) % n], left[k], left[(k + 1) % n]);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      tried = 0;
    } else if (++tried > n) {
      mesh.triangles.resize(before);
      return crossed;
    }
  }
  return "";
}

}  // namespace scree
