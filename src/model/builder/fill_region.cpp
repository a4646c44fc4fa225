#include "model/builder/fill_region.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "mesh/convex_hull.hpp"
#include "mesh/inside.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/connections.hpp"

namespace scree {

namespace {

Vec3 smaller(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 larger(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

// Whether every edge has an even number of triangles, so that the parity of a ray's crossings tells inside
// from outside.
bool is_closed(const TriangleMesh& mesh) {
  std::vector<std::pair<Index, Index>> edges;
  for (const std::array<Index, 3>& v : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(std::minmax(v[k], v[(k + 1) % 3]));
  std::ranges::sort(edges);
  for (auto first = edges.begin(); first != edges.end();) {
    const auto next = std::upper_bound(first, edges.end(), *first);
    if ((next - first) % 2 != 0) return false;
    first = next;
  }
  return true;
}

// A body with the mesh, or the ground, and the mesh's origin in the body's frame [m].
struct MeshOnBody {
  int body = kGround;
  Vec3 offset;
};

// Origin of the mesh on this body; that of the body's frame where the body does not have the mesh.
Vec3 offset_on(const Model& model, int body, int mesh) {
  const Body& of = model.bodies[static_cast<std::size_t>(body)];
  for (const auto* meshes : {&of.meshes, &of.drawn_meshes})
    for (const MeshShape& shape : *meshes)
      if (shape.mesh == mesh) return shape.offset;
  return from_center(model, body, {});
}

MeshOnBody mesh_on_body(const DeckTable& table, const Model& model, const ModelNames& names, int mesh) {
  if (table.has("body")) {
    const int body = find_name(names.bodies, table, "body", "body");
    return {body, offset_on(model, body, mesh)};
  }
  const auto has_mesh = [&](const auto& of) { return of.mesh == mesh; };
  if (std::ranges::any_of(model.walls, has_mesh)) return {};
  std::vector<int> bodies;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& of = model.bodies[static_cast<std::size_t>(b)];
    if (std::ranges::any_of(of.meshes, has_mesh) || std::ranges::any_of(of.drawn_meshes, has_mesh))
      bodies.push_back(b);
  }
  if (bodies.empty()) return {};
  if (bodies.size() > 1)
    table.fail("mesh", fmt::format("is on {} bodies; the key body must name one of them", bodies.size()));
  return {bodies.front(), offset_on(model, bodies.front(), mesh)};
}

// Whether the mesh's inside is solid for particles: it is a closed surface on a wall or on a body that
// collides.
bool is_matter(const Model& model, int mesh) {
  const auto has_mesh = [&](const auto& of) { return of.mesh == mesh; };
  return !model.meshes[static_cast<std::size_t>(mesh)].surface->sheet &&
         (std::ranges::any_of(model.walls, has_mesh) ||
          std::ranges::any_of(model.bodies,
                              [&](const Body& body) { return std::ranges::any_of(body.meshes, has_mesh); }));
}

// The points whose convex hull bounds a body's inside, in its frame [m]: the centres of its shapes and the
// vertices of its meshes.
std::vector<Vec3> points_of(const Model& model, const Body& body) {
  std::vector<Vec3> points;
  for (const Shape& shape : body.shapes) points.push_back(shape.offset);
  for (const MeshShape& shape : body.meshes)
    for (const Vec3 vertex : model.meshes[static_cast<std::size_t>(shape.mesh)].surface->vertices)
      points.push_back(shape.offset + vertex);
  return points;
}

// In 2D the hull is a prism along z.
std::vector<Vec3> standing(const std::vector<Vec3>& points) {
  std::vector<Vec3> upright;
  for (const Vec3 p : points) upright.push_back({p.x, p.y, -1}), upright.push_back({p.x, p.y, 1});
  return upright;
}

struct Plane {
  Vec3 point, normal;  // normal: unit vector, outward
};

std::vector<Plane> planes_of(const TriangleMesh& hull, int dimension) {
  std::vector<Plane> planes;
  for (const std::array<Index, 3>& v : hull.triangles) {
    const auto corner = [&](std::size_t k) { return hull.vertices[static_cast<std::size_t>(v[k])]; };
    const Vec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
    if (!(norm(normal) > 0)) continue;
    const Vec3 unit = (1 / norm(normal)) * normal;
    if (dimension == 3 || std::abs(unit.z) < Real(0.5)) planes.push_back({corner(0), unit});
  }
  return planes;
}

// A unit vector perpendicular to a unit vector.
Vec3 perpendicular_to(Vec3 axis) {
  const Vec3 a{std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)};
  const Vec3 least = a.x <= a.y && a.x <= a.z ? Vec3{1, 0, 0} : a.y <= a.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 beside = cross(axis, least);
  return (1 / norm(beside)) * beside;
}

}  // namespace

FillRegion::FillRegion(const DeckTable& table, const Model& model, const ModelNames& names)
    : dimension_(model.space.dimension), min_(model.space.min), max_(model.space.max) {
  const bool round = table.has("cylinder_radius"), mesh = table.has("mesh"), body = table.has("body");
  for (const char* key : {"min", "max"})
    if (!round && !mesh && !body && !table.has(key))
      table.fail(key, "missing; a random group needs a region: min and max, cylinder_radius, mesh or body");
  if (!round)
    for (const char* key : {"center", "ends"})
      if (table.has(key)) table.fail(key, "not used without cylinder_radius");
  std::vector<std::string> keys;
  for (const char* key : {"min", "max", "cylinder_radius", "mesh", "body"})
    if (table.has(key)) keys.emplace_back(key);
  name_ = fmt::format("{} ({})", round || mesh || body ? "region" : "box", fmt::join(keys, ", "));
  if (round) dimension_ == 2 ? add_circle(table) : add_cylinder(table);
  if (mesh) add_mesh(table, model, names);
  if (body && !mesh) add_body(table, model, names);
  add_box(table);
  // A box that contains little of an oblique cylinder is the better drawing region.
  constexpr Real kMuch = 0.9;
  const Vec3 extent = max_ - min_;
  if (drawn_ && drawn_->volume > kMuch * extent.x * extent.y * extent.z) drawn_.reset();
}

bool FillRegion::holds(Vec3 p, Real radius) const {
  if (drawn_ && !lies_in_box(p, radius)) return false;
  return std::ranges::all_of(parts_, [&](const auto& part) { return part(p, radius); });
}

bool FillRegion::lies_in_box(Vec3 p, Real radius) const {
  const Vec3 below = p - min_, above = max_ - p;
  return std::min({below.x, below.y, below.z, above.x, above.y, above.z}) >= radius;
}

PackingBox FillRegion::packing(Real gap, std::int64_t tries) const {
  PackingBox box{min_, max_, dimension_, gap, tries};
  box.drawn = drawn_;
  return box;
}

Real FillRegion::share(const IsFree& is_free) const {
  constexpr int kPoints = 20000;
  // A very small sphere, as overlaps with surfaces need a radius.
  const Real point = 1e-9 * norm(max_ - min_);
  RandomNumbers random(1);
  int found = 0;
  for (int i = 0; i < kPoints; ++i) {
    Vec3 p;
    if (drawn_) {
      p = drawn_->draw(random, point);
    } else {
      const Real x = random.uniform(min_.x, max_.x), y = random.uniform(min_.y, max_.y);
      p = {x, y, dimension_ == 3 ? random.uniform(min_.z, max_.z) : 0};
    }
    found += holds(p, point) && is_free(p, point);
  }
  return static_cast<Real>(found) / kPoints;
}

void FillRegion::stay_within(Vec3 min, Vec3 max) { min_ = larger(min_, min), max_ = smaller(max_, max); }

void FillRegion::stay_within_points(const std::vector<Vec3>& points) {
  Vec3 min = points.front(), max = min;
  for (const Vec3 p : points) min = smaller(min, p), max = larger(max, p);
  if (dimension_ == 2) min.z = max.z = 0;
  stay_within(min, max);
}

// A plain box may extend beyond the domain; the checks of positions report it.
void FillRegion::add_box(const DeckTable& table) {
  if (is_box()) {
    min_ = table.vector("min"), max_ = table.vector("max");
    return;
  }
  if (table.has("min")) min_ = larger(min_, table.vector("min"));
  if (table.has("max")) max_ = smaller(max_, table.vector("max"));
}

void FillRegion::add_circle(const DeckTable& table) {
  if (table.has("ends")) table.fail("ends", "not used in 2D: cylinder_radius and center are a circle");
  if (!table.has("center")) table.fail("center", "missing; in 2D cylinder_radius needs the circle's centre");
  const Vec3 center = table.vector("center");
  const Real radius = table.real("cylinder_radius");
  parts_.emplace_back([=](Vec3 p, Real r) { return norm(p - center) <= radius - r; });
  stay_within(center - Vec3{radius, radius, 0}, center + Vec3{radius, radius, 0});
}

void FillRegion::add_cylinder(const DeckTable& table) {
  if (table.has("center"))
    table.fail("center", "not used in 3D: ends are the two ends of the cylinder's axis");
  if (!table.has("ends")) table.fail("ends", "missing; cylinder_radius needs the two ends of the axis");
  const Vec3 from = table.vectors("ends")[0], to = table.vectors("ends")[1];
  const Real length = norm(to - from), radius = table.real("cylinder_radius");
  if (!(length > 0)) table.fail("ends", "must not coincide");
  const Vec3 axis = (1 / length) * (to - from);
  parts_.emplace_back([=](Vec3 p, Real r) {
    const Real along = dot(p - from, axis);
    return along >= r && along <= length - r && norm(p - from - along * axis) <= radius - r;
  });
  const Vec3 across = perpendicular_to(axis), third = cross(axis, across);
  drawn_ = DrawnRegion{[=](RandomNumbers& random, Real r) {
                         const Real along = random.uniform(r, length - r);
                         const Real one = random.uniform(r - radius, radius - r);
                         const Real two = random.uniform(r - radius, radius - r);
                         return from + along * axis + one * across + two * third;
                       },
                       4 * radius * radius * length};
  const auto beside = [&](Real u) { return radius * std::sqrt(std::max(1 - u * u, Real(0))); };
  const Vec3 around{beside(axis.x), beside(axis.y), beside(axis.z)};
  stay_within(smaller(from, to) - around, larger(from, to) + around);
}

void FillRegion::add_mesh(const DeckTable& table, const Model& model, const ModelNames& names) {
  const ClosedMesh closed = closed_mesh(table, model, names);
  MeshView view = model.meshes[static_cast<std::size_t>(closed.mesh)].surface->view();
  view.sheet = false;
  const Model* const of = &model;
  parts_.emplace_back([=](Vec3 p, Real r) {
    return contains_sphere(view, to_body_point(*of, closed.body, p) - closed.offset, r);
  });
  stay_within(closed.min, closed.max);
}

void FillRegion::add_body(const DeckTable& table, const Model& model, const ModelNames& names) {
  const int number = find_name(names.bodies, table, "body", "body");
  const std::vector<Vec3> points = points_of(model, model.bodies[static_cast<std::size_t>(number)]);
  if (points.empty()) table.fail("body", "has no shapes and meshes that collide, and so no inside");
  std::vector<Plane> planes;
  try {
    planes = planes_of(convex_hull(dimension_ == 2 ? standing(points) : points), dimension_);
  } catch (const InputError&) {
    table.fail("body", dimension_ == 2 ? "has no inside: its shapes and meshes lie on a line"
                                       : "has no inside: its shapes and meshes lie in a plane");
  }
  const Model* const of = &model;
  parts_.emplace_back([=](Vec3 p, Real r) {
    const Vec3 own = to_body_point(*of, number, p);
    return std::ranges::all_of(
        planes, [&](const Plane& plane) { return dot(own - plane.point, plane.normal) <= -r; });
  });
  std::vector<Vec3> corners;
  for (const Vec3 p : points) corners.push_back(to_global_point(model, number, p));
  stay_within_points(corners);
}

ClosedMesh closed_mesh(const DeckTable& table, const Model& model, const ModelNames& names) {
  ClosedMesh closed;
  closed.mesh = find_name(names.meshes, table, "mesh", "mesh");
  const TriangleMesh& triangles = names.triangles[static_cast<std::size_t>(closed.mesh)].mesh;
  if (!is_closed(triangles))
    table.fail("mesh", "is open and has no inside; a closed mesh is needed, or the key body in its place");
  if (is_matter(model, closed.mesh))
    table.fail(
        "mesh",
        "is a closed solid that collides: its inside is matter; of a file, sheet = true makes a shell of "
        "it, which may hold particles");
  const MeshOnBody on = mesh_on_body(table, model, names, closed.mesh);
  closed.body = on.body, closed.offset = on.offset, closed.volume = std::abs(mesh_volume(triangles));
  closed.min = {kInfinity, kInfinity, kInfinity}, closed.max = -closed.min;
  for (const Vec3 v : model.meshes[static_cast<std::size_t>(closed.mesh)].surface->vertices) {
    const Vec3 p = to_global_point(model, on.body, on.offset + v);
    closed.min = smaller(closed.min, p), closed.max = larger(closed.max, p);
  }
  if (model.space.dimension == 2) closed.min.z = closed.max.z = 0;
  return closed;
}

bool is_clear_of_planes(const Model& model, Vec3 p, Real radius) {
  constexpr Real kRoundOff = 1e-9;
  return std::ranges::all_of(model.walls, [&](const Wall& wall) {
    return wall.mesh >= 0 || dot(wall.normal, p - wall.point) >= (1 - kRoundOff) * radius;
  });
}

}  // namespace scree
