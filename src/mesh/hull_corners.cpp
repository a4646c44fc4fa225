#include "mesh/hull_corners.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "mesh/convex_hull.hpp"
#include "mesh/mesh_mass.hpp"

namespace scree {
namespace {

constexpr Real kRoundOff = 1e-9;  // tolerance for points on a plane or a line, relative to the extent
constexpr Index kNone = -1;

Real extent_of(const std::vector<Vec3>& points) {
  Real squared = 0;
  for (const Vec3 p : points) squared = std::max(squared, dot(p - points.front(), p - points.front()));
  return std::sqrt(squared);
}

// A point by its coordinates in a plane, and its number.
struct PlanePoint {
  Real x, y;
  Index point;
};

// Twice the area of the triangle, positive where the polyline a, b, c bends left: the distance of b from the
// line through a and c, times the distance of a and c.
Real orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Strict corners of the hull, counterclockwise: Andrew's monotone chain, Inf. Process. Lett. 9, 216 (1979).
std::vector<PlanePoint> outline(std::vector<PlanePoint> points, Real tolerance) {
  std::ranges::sort(points, [](const PlanePoint& a, const PlanePoint& b) {
    return std::tuple(a.x, a.y, a.point) < std::tuple(b.x, b.y, b.point);
  });
  const auto same = [](const PlanePoint& a, const PlanePoint& b) { return a.x == b.x && a.y == b.y; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  std::vector<PlanePoint> chain;
  const auto add = [&](const PlanePoint& p, std::size_t begin) {
    const auto is_corner = [&](const PlanePoint& a, const PlanePoint& b) {
      return orientation(a, b, p) > tolerance * std::hypot(p.x - a.x, p.y - a.y);
    };
    while (chain.size() >= begin + 2 && !is_corner(chain[chain.size() - 2], chain.back())) chain.pop_back();
    chain.push_back(p);
  };
  for (const PlanePoint& p : points) add(p, 0);
  if (points.size() < 2) return chain;
  const std::size_t upper = chain.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, upper);
  chain.pop_back();
  return chain;
}

Real length_of(const std::vector<PlanePoint>& corners) {
  Real length = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const PlanePoint &a = corners[k], &b = corners[(k + 1) % corners.size()];
    length += std::hypot(b.x - a.x, b.y - a.y);
  }
  return length;
}

Real area_of(const std::vector<PlanePoint>& corners) {
  Real area = 0;
  for (std::size_t k = 2; k < corners.size(); ++k)
    area += orientation(corners[0], corners[k - 1], corners[k]) / 2;
  return area;
}

// Corners by the numbers of the points, and the position of each point among them.
std::vector<Index> take_corners(const std::vector<Vec3>& points, std::vector<Index> numbers,
                                HullCorners& out) {
  std::ranges::sort(numbers);
  std::vector<Index> position(points.size(), kNone);
  for (const Index number : numbers) {
    position[static_cast<std::size_t>(number)] = static_cast<Index>(out.corners.size());
    out.corners.push_back(points[static_cast<std::size_t>(number)]);
  }
  return position;
}

void add_face(const std::vector<Index>& corners, Vec3 normal, HullCorners& out) {
  if (out.first.empty()) out.first.push_back(0);
  out.face_corners.insert(out.face_corners.end(), corners.begin(), corners.end());
  out.first.push_back(static_cast<Index>(out.face_corners.size()));
  out.normals.push_back(normal);
}

std::vector<Index> numbers_of(const std::vector<PlanePoint>& corners) {
  std::vector<Index> numbers;
  for (const PlanePoint& p : corners) numbers.push_back(p.point);
  return numbers;
}

HullCorners corners_of_outline(const std::vector<Vec3>& given) {
  std::vector<Vec3> points = given;
  std::vector<PlanePoint> in_plane;
  for (Vec3& p : points) p.z = 0, in_plane.push_back({p.x, p.y, static_cast<Index>(in_plane.size())});
  const std::vector<PlanePoint> corners = outline(in_plane, kRoundOff * extent_of(points));
  HullCorners out;
  const std::vector<Index> position = take_corners(points, numbers_of(corners), out);
  out.radius = length_of(corners) / (2 * std::numbers::pi_v<Real>);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const PlanePoint &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const Vec3 normal{b.y - a.y, a.x - b.x, 0};
    add_face({position[static_cast<std::size_t>(a.point)], position[static_cast<std::size_t>(b.point)]},
             (1 / norm(normal)) * normal, out);
  }
  return out;
}

// Corners of coplanar points in space: both sides of the plane are faces.
HullCorners corners_of_flat(const std::vector<Vec3>& points) {
  const Vec3 a = points.front();
  const auto farthest = [&](const auto& measure) {
    return *std::ranges::max_element(points, {}, [&](Vec3 p) { return dot(measure(p), measure(p)); });
  };
  const Vec3 edge = farthest([&](Vec3 p) { return p - a; }) - a;
  const Vec3 x = (1 / norm(edge)) * edge;
  const Vec3 across = cross(x, farthest([&](Vec3 p) { return cross(x, p - a); }) - a);
  const Vec3 normal = (1 / norm(across)) * across, y = cross(normal, x);
  std::vector<PlanePoint> in_plane;
  for (const Vec3 p : points)
    in_plane.push_back({dot(x, p - a), dot(y, p - a), static_cast<Index>(in_plane.size())});
  const std::vector<PlanePoint> corners = outline(in_plane, kRoundOff * extent_of(points));
  HullCorners out;
  take_corners(points, numbers_of(corners), out);
  std::vector<Index> all(out.corners.size());
  std::iota(all.begin(), all.end(), 0);
  add_face(all, normal, out), add_face(all, -normal, out);
  out.radius = std::sqrt(2 * area_of(corners) / (4 * std::numbers::pi_v<Real>));
  return out;
}

Vec3 twice_area(const TriangleMesh& mesh, std::size_t t) {
  const auto at = [&](std::size_t k) {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
  };
  return cross(at(1) - at(0), at(2) - at(0));
}

// The faces of a hull: their number for each triangle, and their normals. Starting from the largest
// triangle, connected coplanar triangles form one face; slivers join it whatever their own normals are.
class HullFaces {
 public:
  HullFaces(const TriangleMesh& hull, Real tolerance) : hull_(hull), tolerance_(tolerance) {
    const std::size_t count = hull.triangles.size();
    for (std::size_t t = 0; t < count; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        edges_.push_back({hull.triangles[t][k], hull.triangles[t][(k + 1) % 3], t});
    std::ranges::sort(edges_, {}, &Edge::ends);
    std::vector<Real> size;
    for (std::size_t t = 0; t < count; ++t) size.push_back(norm(twice_area(hull, t)));
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t t) { return size[t]; });
    face_.assign(count, kNone);
    for (const std::size_t t : order)
      if (face_[t] == kNone && size[t] > 0) grow(t, (1 / size[t]) * twice_area(hull, t));
  }
  Index of(std::size_t triangle) const { return face_[triangle]; }
  const std::vector<Vec3>& normals() const { return normals_; }

 private:
  struct Edge {
    Index from, to;
    std::size_t triangle;  // to the left of the edge
    std::pair<Index, Index> ends() const { return {from, to}; }
  };
  void grow(std::size_t seed, Vec3 normal) {
    const auto face = static_cast<Index>(normals_.size());
    normals_.push_back(normal);
    const Vec3 point = vertex(hull_.triangles[seed][0]);
    std::vector<std::size_t> open{seed};
    face_[seed] = face;
    while (!open.empty()) {
      const auto corner = hull_.triangles[open.back()];
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = on_left(corner[(k + 1) % 3], corner[k]);
        const bool in_plane = std::ranges::all_of(hull_.triangles[next], [&](Index v) {
          return std::abs(dot(normal, vertex(v) - point)) <= tolerance_;
        });
        if (face_[next] != kNone || !in_plane) continue;
        face_[next] = face;
        open.push_back(next);
      }
    }
  }
  Vec3 vertex(Index v) const { return hull_.vertices[static_cast<std::size_t>(v)]; }
  std::size_t on_left(Index from, Index to) const {
    return std::ranges::lower_bound(edges_, std::pair(from, to), {}, &Edge::ends)->triangle;
  }

  const TriangleMesh& hull_;
  Real tolerance_;
  std::vector<Edge> edges_;  // sorted by their ends
  std::vector<Index> face_;
  std::vector<Vec3> normals_;
};

HullCorners corners_of_solid(const std::vector<Vec3>& points, const TriangleMesh& hull) {
  const HullFaces faces(hull, kRoundOff * extent_of(points));
  std::vector<std::pair<Index, Index>> incidences;  // pairs of a vertex and a face
  for (std::size_t t = 0; t < hull.triangles.size(); ++t)
    for (const Index v : hull.triangles[t])
      if (faces.of(t) != kNone) incidences.emplace_back(v, faces.of(t));
  std::ranges::sort(incidences);
  incidences.erase(std::unique(incidences.begin(), incidences.end()), incidences.end());
  HullCorners out;
  std::vector<std::vector<Index>> corners_of(faces.normals().size());
  for (std::size_t k = 0, end; k < incidences.size(); k = end) {
    const Index vertex = incidences[k].first;
    for (end = k; end < incidences.size() && incidences[end].first == vertex;) ++end;
    if (end - k < 3) continue;  // inside a face or an edge
    for (std::size_t at = k; at < end; ++at)
      corners_of[static_cast<std::size_t>(incidences[at].second)].push_back(
          static_cast<Index>(out.corners.size()));
    out.corners.push_back(hull.vertices[static_cast<std::size_t>(vertex)]);
  }
  for (std::size_t f = 0; f < corners_of.size(); ++f) add_face(corners_of[f], faces.normals()[f], out);
  out.radius = std::sqrt(mesh_area(hull) / (4 * std::numbers::pi_v<Real>));
  return out;
}

std::optional<TriangleMesh> solid_hull(const std::vector<Vec3>& points) {
  try {
    return convex_hull(points);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

HullCorners unbounded_corners(const std::vector<Vec3>& points, bool planar) {
  if (planar) return corners_of_outline(points);
  const std::optional<TriangleMesh> hull = solid_hull(points);
  return hull ? corners_of_solid(points, *hull) : corners_of_flat(points);
}

}  // namespace

HullCorners hull_corners(const std::vector<Vec3>& points, bool planar) {
  HullCorners out = unbounded_corners(points, planar);
  Vec3 min = out.corners.front(), max = min;
  for (const Vec3 p : out.corners) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  out.middle = Real(0.5) * (min + max);
  for (const Vec3 p : out.corners) out.bounding_radius = std::max(out.bounding_radius, norm(p - out.middle));
  return out;
}

}  // namespace scree
