#include "model/builder/make_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "deck/choices.hpp"
#include "mesh/facets.hpp"
#include "mesh/primitives.hpp"
#include "mesh/read_mesh.hpp"
#include "model/derived/frames.hpp"

namespace scree {
namespace {

Vec3 size_of(const DeckTable& table, std::size_t entries) {
  const std::vector<Real>& size = table.reals("size");
  if (size.size() != entries) table.fail("size", fmt::format("must have {} entries", entries));
  return {size[0], size[1], entries > 2 ? size[2] : 0};
}

Index segments_of(const DeckTable& table) { return static_cast<Index>(table.integer("segments")); }

// The deck's names of the dimensions of a pipe and a screw differ from those of their shapes.
void check_smaller(const DeckTable& table, const std::string& key, const std::string& than) {
  if (!(table.real(key) < table.real(than)))
    table.fail(key, fmt::format("must be below {} = {}", than, table.real(than)));
}

template <class Shape>
MadeMesh sound(const DeckTable& table, const Shape& shape, TriangleMesh (*make)(const Shape&)) {
  if (const std::string trouble = shape_defect(shape); !trouble.empty()) table.fail("kind", trouble);
  return {make(shape), facet_deviation(shape)};
}

DrumShape drum_of(const DeckTable& table) {
  const auto lifters = static_cast<Index>(table.integer("lifters"));
  for (const char* key : {"lifter_height", "lifter_width"})
    if ((lifters > 0) != table.has(key))
      table.fail(key, lifters > 0 ? "missing; lifters are given" : "not used without lifters");
  const auto of_lifters = [&](const char* key) { return lifters > 0 ? table.real(key) : 0; };
  return {table.real("radius"),
          table.real("wall"),
          table.real("length"),
          table.real("end_wall"),
          lifters,
          of_lifters("lifter_height"),
          of_lifters("lifter_width"),
          segments_of(table)};
}

ScrewShape screw_of(const DeckTable& table) {
  check_smaller(table, "core_radius", "radius");
  const Real length = table.real("length");
  return {table.real("core_radius"),
          table.real("radius"),
          table.real("pitch"),
          table.real("thickness"),
          length,
          table.has("core_length") ? table.real("core_length") : length,
          segments_of(table)};
}

// Points with intermediate points on the segments, so that no segment is longer than `longest` [m].
std::vector<Vec3> with_points_between(const std::vector<Vec3>& points, bool closed, Real longest) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.push_back(points[i]);
    if (!closed && i + 1 == points.size()) break;
    const Vec3 apart = points[(i + 1) % points.size()] - points[i];
    const auto parts = static_cast<int>(std::ceil(norm(apart) / longest));
    for (int k = 1; k < parts; ++k) all.push_back(points[i] + (Real(k) / parts) * apart);
  }
  return all;
}

// Points of a line, with all checks except for self-intersection.
const std::vector<Vec3>& line_points(const DeckTable& table) {
  const std::vector<Vec3>& points = table.vectors("points");
  const bool closed = table.boolean("closed");
  const std::size_t least = closed ? 3 : 2;
  if (points.size() < least) table.fail("points", fmt::format("must be at least {}", least));
  Real area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 a = points[i], b = points[(i + 1) % points.size()];
    const bool joined = closed || i + 1 < points.size();
    if (joined && a == b)
      table.fail("points", fmt::format("must be apart, one from the next{}: ({:g}, {:g}) stands twice",
                                       closed ? " and the last from the first" : "", a.x, a.y));
    area += cross(a - points[0], b - points[0]).z / 2;
  }
  if (closed && !(area > 0))
    table.fail(
        "points",
        fmt::format("enclose an area of {:.4g} m^2; they must be in counterclockwise order around the solid",
                    area));
  return points;
}

Real length_of(const std::vector<Vec3>& points, bool closed) {
  Real length = closed ? norm(points.back() - points.front()) : 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += norm(points[i] - points[i - 1]);
  return length;
}

TriangleMesh line_of(const DeckTable& table, Real half_depth) {
  constexpr Real kMostSegments = 1e7;
  const std::vector<Vec3>& points = line_points(table);
  const bool closed = table.boolean("closed");
  if (!table.has("refine")) return extruded_line_mesh(points, closed, half_depth);
  const Real longest = table.real("refine"), length = length_of(points, closed);
  if (!(length / longest < kMostSegments))
    table.fail("refine", fmt::format("must be above the length of the line / {:g} = {:.4g}", kMostSegments,
                                     length / kMostSegments));
  return extruded_line_mesh(with_points_between(points, closed, longest), closed, half_depth);
}

TriangleMesh read(const DeckTable& table) {
  try {
    return read_mesh(table.text("file"));
  } catch (const InputError& error) {
    table.fail("file", error.what());
  }
}

MadeMesh made(const DeckTable& table, Real half_depth) {
  const auto radius = [&] { return table.real("radius"); };
  const auto length = [&] { return table.real("length"); };
  switch (table.choice<MeshKind>("kind")) {
    case MeshKind::file:
      return {read(table), std::nullopt};
    case MeshKind::box:
      return sound(table, BoxShape{size_of(table, 3)}, box_mesh);
    case MeshKind::cylinder:
      return sound(table, CylinderShape{radius(), length(), segments_of(table)}, cylinder_mesh);
    case MeshKind::cone:
      return sound(table, ConeShape{radius(), table.real("top_radius"), length(), segments_of(table)},
                   cone_mesh);
    case MeshKind::sphere:
      return sound(table, SphereShape{radius(), static_cast<int>(table.integer("levels"))}, sphere_mesh);
    case MeshKind::capsule:
      return sound(table, CapsuleShape{radius(), length(), segments_of(table)}, capsule_mesh);
    case MeshKind::plate:
      return sound(table, PlateShape{size_of(table, 3), table.real("hole_radius"), segments_of(table)},
                   plate_mesh);
    case MeshKind::pipe:
      check_smaller(table, "inner_radius", "radius");
      return sound(table, PipeShape{table.real("inner_radius"), radius(), length(), segments_of(table)},
                   pipe_mesh);
    case MeshKind::drum:
      return sound(table, drum_of(table), drum_mesh);
    case MeshKind::screw:
      return sound(table, screw_of(table), screw_mesh);
    case MeshKind::funnel:
      return sound(table,
                   FunnelShape{radius(), table.real("top_radius"), length(), table.real("outlet_length"),
                               segments_of(table)},
                   funnel_mesh);
    case MeshKind::hopper: {
      const std::vector<Real>& top = table.reals("top_size");
      const HopperShape shape{size_of(table, 2), {top[0], top[1], 0}, length(), table.real("outlet_length")};
      return sound(table, shape, hopper_mesh);
    }
    case MeshKind::rectangle: {
      const Vec3 size = size_of(table, 2);
      return {rectangle_mesh(size.x, size.y), 0};
    }
    case MeshKind::line:
      break;
  }
  return {line_of(table, half_depth), std::nullopt};
}

// Factors along the axes of the generated mesh. A mirroring factor reverses the orientation of its triangles.
Vec3 size_factors(const DeckTable& table, TriangleMesh& mesh) {
  const Real scale = table.has("scale") ? table.real("scale") : 1;
  if (!table.has("stretch")) return {scale, scale, scale};
  const std::vector<Real>& s = table.reals("stretch");
  const Vec3 factors{scale * s[0], scale * s[1], scale * s[2]};
  if (factors.x == 0 || factors.y == 0 || factors.z == 0)
    table.fail("stretch", "none of the three factors may be 0");
  if ((factors.x < 0) ^ (factors.y < 0) ^ (factors.z < 0))
    for (std::array<Index, 3>& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return factors;
}

TriangleMesh placed(const DeckTable& table, TriangleMesh mesh) {
  const Quaternion turn = read_orientation(table);
  const Mat3 axes = rotation_matrix(turn);
  if (table.choice<MeshKind>("kind") == MeshKind::line) check_rotated_about_z(table, axes);
  const Vec3 offset = table.vector("offset");
  const Vec3 factors = size_factors(table, mesh);
  for (Vec3& vertex : mesh.vertices) {
    vertex = {factors.x * vertex.x, factors.y * vertex.y, factors.z * vertex.z};
    vertex = (turn.w == 1 ? vertex : axes * vertex) + offset;
  }
  return mesh;
}

}  // namespace

void check_rotated_about_z(const DeckTable& table, const Mat3& axes) {
  constexpr Real kRoundOff = 1e-12;
  const Vec3 z = axes * Vec3{0, 0, 1};
  if (norm(z - Vec3{0, 0, 1}) <= kRoundOff) return;
  const auto given = [&](const char* key) { return table.has(key); };
  const auto keys = {"rotation_axis", "quaternion", "z_axis", "x_axis"};
  table.fail(
      *std::ranges::find_if(keys, given),
      "lines lie in the x-y plane and turn about z alone: quaternion = [cos(a/2), 0, 0, sin(a/2)] turns "
      "them by a");
}

bool is_open_surface(const DeckTable& table) {
  switch (table.choice<MeshKind>("kind")) {
    case MeshKind::file:
      return table.boolean("sheet");
    case MeshKind::line:
      return !table.boolean("closed");
    case MeshKind::funnel:
    case MeshKind::hopper:
    case MeshKind::rectangle:
      return true;
    default:
      return false;
  }
}

MadeMesh make_mesh(const DeckTable& table, Real half_depth) {
  MadeMesh mesh = made(table, half_depth);
  mesh.triangles = placed(table, std::move(mesh.triangles));
  return mesh;
}

TriangleMesh make_line_solid(const DeckTable& table) {
  const std::vector<Vec3>& points = line_points(table);
  if (!table.boolean("closed")) return placed(table, extruded_line_mesh(points, false, 1));
  try {
    return placed(table, extruded_outline_mesh(points, 1));
  } catch (const InputError& error) {
    table.fail("points", error.what());
  }
}

}  // namespace scree
