#include "mesh/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/error.hpp"
#include "mesh/mesh_builder.hpp"
#include "mesh/polygon.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// A point of a line in the half plane of radius and height that is rotated about z.
struct ProfilePoint {
  Real radius, z;
};

// The surface of revolution of the line, which runs upwards where it is the outside; points at radius 0 are
// on the axis.
TriangleMesh revolved(const std::vector<ProfilePoint>& profile, bool closed, Index segments) {
  MeshBuilder builder;
  std::vector<Ring> rings;
  for (const auto [radius, z] : profile) {
    Ring ring;
    for (Index k = 0; k < (radius == 0 ? 1 : segments); ++k) {
      const Vec3 on_circle = radius * circle_point(k, segments);
      ring.push_back(builder.vertex({on_circle.x, on_circle.y, z}));
    }
    rings.push_back(std::move(ring));
  }
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) builder.strip(rings[k], rings[k + 1], true);
  if (closed) builder.strip(rings.back(), rings.front(), true);
  return builder.take();
}

// This orientation of the icosahedron is symmetric about the coordinate planes.
TriangleMesh icosahedron() {
  const Real g = std::numbers::phi_v<Real>;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

// Splits every triangle into four, with new vertices at the middles of its edges.
TriangleMesh split_in_four(const TriangleMesh& mesh) {
  TriangleMesh fine{mesh.vertices, {}};
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [entry, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<Index>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(Real(0.5) * (mesh.vertices[a] + mesh.vertices[b]));
    return entry->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<Index, 3>& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      fine.triangles.push_back(part);
  }
  return fine;
}

}  // namespace

Vec3 circle_point(std::int64_t k, std::int64_t n) {
  // Angles in units of an eighth of a revolution over n, mirrored into the first eighth.
  std::int64_t angle = 8 * (k % n);
  Vec3 sign{1, 1, 0};
  if (angle > 4 * n) angle = 8 * n - angle, sign.y = -1;
  if (angle > 2 * n) angle = 4 * n - angle, sign.x = -1;
  const bool swapped = angle > n;
  if (swapped) angle = 2 * n - angle;
  const Real radians = kPi / 4 * static_cast<Real>(angle) / static_cast<Real>(n);
  const Real c = std::cos(radians), s = angle == n ? c : std::sin(radians);
  return swapped ? Vec3{sign.x * s, sign.y * c, 0} : Vec3{sign.x * c, sign.y * s, 0};
}

Index segments_within(Real radius, Real sag) {
  // r (1 - cos(pi / n)) <= sag
  const Real half_angle = 2 * std::asin(std::sqrt(std::min<Real>(1, sag / radius) / 2));
  return 4 * std::max<Index>(1, static_cast<Index>(std::ceil(kPi / half_angle / 4)));
}

TriangleMesh box_mesh(const BoxShape& shape) {
  const Vec3 h = Real(0.5) * shape.size;
  MeshBuilder builder;
  const std::vector<Vec3> corners{{-h.x, -h.y, 0}, {h.x, -h.y, 0}, {h.x, h.y, 0}, {-h.x, h.y, 0}};
  const Ring low = builder.ring(corners, -h.z), high = builder.ring(corners, h.z);
  builder.quad(low[0], low[3], low[2], low[1]);
  builder.strip(low, high, true);
  builder.quad(high[0], high[1], high[2], high[3]);
  return builder.take();
}

TriangleMesh cylinder_mesh(const CylinderShape& shape) {
  const Real h = shape.length / 2;
  return revolved({{0, -h}, {shape.radius, -h}, {shape.radius, h}, {0, h}}, false, shape.segments);
}

TriangleMesh cone_mesh(const ConeShape& shape) {
  std::vector<ProfilePoint> profile{{0, 0}, {shape.radius, 0}, {shape.top_radius, shape.length}};
  if (shape.top_radius > 0) profile.push_back({0, shape.length});
  return revolved(profile, false, shape.segments);
}

TriangleMesh sphere_mesh(const SphereShape& shape) {
  TriangleMesh mesh = icosahedron();
  for (int level = 0; level <= shape.levels; ++level) {
    if (level > 0) mesh = split_in_four(mesh);
    for (Vec3& v : mesh.vertices) v = (level < shape.levels ? 1 : shape.radius) / norm(v) * v;
  }
  return mesh;
}

TriangleMesh capsule_mesh(const CapsuleShape& shape) {
  const Index quarter = shape.segments / 4;
  const Real h = shape.length / 2;
  std::vector<ProfilePoint> profile;
  for (const int side : {-1, 1}) {
    for (Index k = 0; k <= quarter; ++k) {
      const Vec3 p = shape.radius * circle_point(side < 0 ? k - quarter + shape.segments : k, shape.segments);
      profile.push_back({p.x, side * h + p.y});
    }
  }
  return revolved(profile, false, shape.segments);
}

TriangleMesh pipe_mesh(const PipeShape& shape) {
  const Real h = shape.length / 2, inner = shape.inner_radius, outer = shape.outer_radius;
  return revolved({{outer, -h}, {outer, h}, {inner, h}, {inner, -h}}, true, shape.segments);
}

TriangleMesh plate_mesh(const PlateShape& shape) {
  const Vec3 h = Real(0.5) * shape.size;
  const std::vector<Vec3> corners{{h.x, h.y, 0}, {-h.x, h.y, 0}, {-h.x, -h.y, 0}, {h.x, -h.y, 0}};
  std::vector<Vec3> hole;
  for (Index k = 0; k < shape.segments; ++k)
    hole.push_back(shape.hole_radius * circle_point(k, shape.segments));
  MeshBuilder builder;
  const Ring low = builder.ring(corners, -h.z), high = builder.ring(corners, h.z);
  const Ring hole_low = builder.ring(hole, -h.z), hole_high = builder.ring(hole, h.z);
  builder.strip(low, high, true);
  builder.strip(hole_high, hole_low, true);
  // Corner j follows the hole's quarter j and precedes the triangle to the next corner.
  const Index quarter = shape.segments / 4;
  for (Index j = 0; j < 4; ++j) {
    for (Index k = j * quarter; k < (j + 1) * quarter; ++k) {
      const Index next = (k + 1) % shape.segments;
      builder.triangle(hole_high[k], high[j], hole_high[next]);
      builder.triangle(hole_low[k], hole_low[next], low[j]);
    }
    const Index axis = (j + 1) * quarter % shape.segments, after = (j + 1) % 4;
    builder.triangle(hole_high[axis], high[j], high[after]);
    builder.triangle(hole_low[axis], low[after], low[j]);
  }
  return builder.take();
}

TriangleMesh funnel_mesh(const FunnelShape& shape) {
  std::vector<ProfilePoint> profile{{shape.radius, 0}, {shape.top_radius, shape.length}};
  if (shape.outlet_length > 0) profile.insert(profile.begin(), {shape.radius, -shape.outlet_length});
  return revolved(profile, false, shape.segments);
}

TriangleMesh hopper_mesh(const HopperShape& shape) {
  const auto corners = [](Vec3 size) {
    const Real x = size.x / 2, y = size.y / 2;
    return std::vector<Vec3>{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}};
  };
  MeshBuilder builder;
  const Ring outlet = builder.ring(corners(shape.size), 0);
  if (shape.outlet_length > 0)
    builder.strip(builder.ring(corners(shape.size), -shape.outlet_length), outlet, true);
  builder.strip(outlet, builder.ring(corners(shape.top_size), shape.length), true);
  return builder.take();
}

TriangleMesh rectangle_mesh(Real width, Real depth) {
  const Real x = width / 2, y = depth / 2;
  return {{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

namespace {

struct DrawnLine {
  TriangleMesh mesh;
  Ring low, high;
};

DrawnLine drawn_line(const std::vector<Vec3>& points, bool closed, Real half_depth) {
  int exponent = 0;
  const bool is_power = std::frexp(half_depth, &exponent) == Real(0.5);
  const Real end = std::ldexp(Real(1), is_power ? exponent - 1 : exponent);
  MeshBuilder builder;
  const Ring low = builder.ring(points, -end), high = builder.ring(points, end);
  builder.strip(low, high, closed);
  return {builder.take(), low, high};
}

}  // namespace

TriangleMesh extruded_line_mesh(const std::vector<Vec3>& points, bool closed, Real half_depth) {
  return drawn_line(points, closed, half_depth).mesh;
}

TriangleMesh extruded_outline_mesh(const std::vector<Vec3>& points, Real half_depth) {
  auto [mesh, low, high] = drawn_line(points, true, half_depth);
  for (const Ring& end_face : {reversed(low), high}) {
    const std::string trouble = add_polygon(mesh, end_face);
    if (!trouble.empty()) throw InputError("the closed line is no outline: " + trouble);
  }
  return mesh;
}

TriangleMesh without_ends(TriangleMesh outline) {
  std::erase_if(outline.triangles, [&](const std::array<Index, 3>& t) {
    const auto is_high = [&](Index corner) { return outline.vertices[corner].z > 0; };
    return is_high(t[0]) == is_high(t[1]) && is_high(t[1]) == is_high(t[2]);
  });
  return outline;
}

TriangleMesh line_of_depth(TriangleMesh line, Real depth) {
  for (Vec3& vertex : line.vertices) vertex.z = std::copysign(depth / 2, vertex.z);
  return line;
}

}  // namespace scree
