#include "model/derived/posed_meshes.hpp"

#include <algorithm>
#include <cmath>

#include "base/mat3.hpp"
#include "mesh/inside.hpp"
#include "mesh/mesh_tree.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/connections.hpp"

namespace scree {

namespace {

// c: the sphere's centre in the frame of the mesh.
Real overlap_at(const MeshView& mesh, Vec3 c, Real radius) {
  const MeshBox& around = mesh.boxes[mesh.level_start[mesh.levels - 1]];
  if (!(squared_distance(around, c) < radius * radius)) return 0;
  Real nearest = radius * radius;
  for_each_triangle_near(mesh, c, radius, [&](Index t) {
    const Index* v = mesh.triangles[t].vertex;
    nearest =
        std::min(nearest, squared_distance(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]], c));
  });
  const Real distance = std::min(std::sqrt(nearest), radius);
  return is_inside(mesh, c) ? radius + distance : radius - distance;
}

// The components of `periods` that equal the extent of a mesh with this box and these axes (rows); 0
// otherwise.
Vec3 spanned_by(const MeshBox& box, const Mat3& axes, Vec3 periods) {
  const Vec3 size = box.max - box.min;
  const auto along = [&](Real x, Real y, Real z, Real period) {
    return std::abs(x) * size.x + std::abs(y) * size.y + std::abs(z) * size.z >= period ? period : 0;
  };
  return {along(axes.x.x, axes.y.x, axes.z.x, periods.x), along(axes.x.y, axes.y.y, axes.z.y, periods.y),
          along(axes.x.z, axes.y.z, axes.z.z, periods.z)};
}

// The image of x that is nearest to `middle`.
Real beside(Real middle, Real x, Real period) {
  return period > 0 ? x - std::floor((x - middle) / period + Real(0.5)) * period : x;
}

}  // namespace

Real PosedMesh::overlap(Vec3 p, Real radius) const {
  const Vec3 q{beside(middle.x, p.x, spanned.x), beside(middle.y, p.y, spanned.y),
               beside(middle.z, p.z, spanned.z)};
  Real largest = 0;
  for (const Vec3 shift : shifts)
    largest = std::max(largest, overlap_at(mesh, axes * (q + shift - point), radius));
  return largest;
}

Vec3 in_periodic_box(const Space& space, Vec3 p) {
  const auto along = [&](int side, Real min, Real max, Real& x) {
    if (space.boundary[side] != Boundary::periodic) return;
    const Real period = max - min;
    x -= std::floor((x - min) / period) * period;
  };
  along(kXMin, space.min.x, space.max.x, p.x);
  along(kYMin, space.min.y, space.max.y, p.y);
  along(kZMin, space.min.z, space.max.z, p.z);
  return p;
}

Vec3 periods_of(const Space& space) {
  const Vec3 extent = space.max - space.min;
  const auto period = [&](int side, Real length) {
    return space.boundary[side] == Boundary::periodic ? length : 0;
  };
  return {period(kXMin, extent.x), period(kYMin, extent.y), period(kZMin, extent.z)};
}

std::vector<Vec3> image_shifts(Vec3 periods) {
  const auto along = [&](Vec3 period) {
    return period == Vec3{} ? std::vector{period} : std::vector{-period, Vec3{}, period};
  };
  std::vector<Vec3> shifts;
  for (const Vec3 x : along({periods.x, 0, 0}))
    for (const Vec3 y : along({0, periods.y, 0}))
      for (const Vec3 z : along({0, 0, periods.z})) shifts.push_back(x + y + z);
  return shifts;
}

PosedMeshes::PosedMeshes(const Model& model) : space_(model.space) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    for (const MeshShape& shape : model.bodies[static_cast<std::size_t>(b)].meshes)
      add({{}, b, -1, shape.material, to_global_point(model, b, shape.offset), global_frame(model, b, {})},
          *model.meshes[static_cast<std::size_t>(shape.mesh)].surface);
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w) {
    const Wall& wall = model.walls[static_cast<std::size_t>(w)];
    if (wall.mesh >= 0)
      add({{}, kGround, w, wall.material, wall.point, identity3()},
          *model.meshes[static_cast<std::size_t>(wall.mesh)].surface);
  }
}

PosedMeshes::PosedMeshes(const Model& model, std::span<const BodyMotion> motion) : space_(model.space) {
  const auto axes = [](const BodyMotion& of) { return transposed(rotation_matrix(orientation(of))); };
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const BodyMotion& of = motion[static_cast<std::size_t>(b)];
    for (const MeshShape& shape : model.bodies[static_cast<std::size_t>(b)].meshes)
      add({{}, b, -1, shape.material, point_motion(of, shape.offset).position, axes(of)},
          *model.meshes[static_cast<std::size_t>(shape.mesh)].surface);
  }
  std::size_t parent = model.bodies.size();
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w) {
    const Wall& wall = model.walls[static_cast<std::size_t>(w)];
    if (!wall.has_pose()) continue;
    const BodyMotion& of = motion[parent++];
    if (wall.mesh >= 0)
      add({{}, kGround, w, wall.material, of.position, axes(of)},
          *model.meshes[static_cast<std::size_t>(wall.mesh)].surface);
  }
}

// Completes the mesh with its surface and its images.
void PosedMeshes::add(PosedMesh mesh, const SurfaceMesh& surface) {
  const Vec3 periods = periods_of(space_);
  mesh.mesh = surface.view(), mesh.point = in_periodic_box(space_, mesh.point);
  mesh.middle = mesh.point + transposed_times(mesh.axes, Real(0.5) * (surface.box.min + surface.box.max));
  mesh.spanned = spanned_by(surface.box, mesh.axes, periods);
  mesh.shifts = image_shifts(periods - mesh.spanned);
  meshes_.push_back(std::move(mesh));
}

bool PosedMeshes::is_clear(Vec3 p, Real radius, Real gap) const {
  const Vec3 q = in_periodic_box(space_, p);
  return std::ranges::all_of(meshes_,
                             [&](const PosedMesh& mesh) { return !(mesh.overlap(q, radius + gap) > 0); });
}

}  // namespace scree
