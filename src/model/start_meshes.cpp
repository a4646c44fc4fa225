#include "model/start_meshes.hpp"

#include <algorithm>
#include <cmath>

#include "base/mat3.hpp"
#include "mesh/inside.hpp"
#include "mesh/mesh_tree.hpp"
#include "model/connections.hpp"

namespace scree {

Real StartMesh::overlap(Vec3 p, Real radius) const {
  const Vec3 c = axes * (p - point);
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

std::vector<Vec3> image_shifts(const Space& space) {
  const Vec3 extent = space.max - space.min;
  const auto periods = [&](int side, Vec3 period) {
    return space.boundary[side] == Boundary::periodic ? std::vector{-period, Vec3{}, period}
                                                      : std::vector{Vec3{}};
  };
  std::vector<Vec3> shifts;
  for (const Vec3 x : periods(kXMin, {extent.x, 0, 0})) {
    for (const Vec3 y : periods(kYMin, {0, extent.y, 0})) {
      for (const Vec3 z : periods(kZMin, {0, 0, extent.z})) shifts.push_back(x + y + z);
    }
  }
  return shifts;
}

StartMeshes::StartMeshes(const Model& model) : space_(model.space), shifts_(image_shifts(model.space)) {
  const auto view = [&](int mesh) { return model.meshes[static_cast<std::size_t>(mesh)].surface->view(); };
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    for (const MeshShape& shape : model.bodies[static_cast<std::size_t>(b)].meshes)
      meshes_.push_back({view(shape.mesh), b, -1,
                         in_periodic_box(space_, to_global_point(model, b, shape.offset)),
                         global_frame(model, b, {})});
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w) {
    const Wall& wall = model.walls[static_cast<std::size_t>(w)];
    if (wall.mesh >= 0)
      meshes_.push_back({view(wall.mesh), kGround, w, in_periodic_box(space_, wall.point), identity3()});
  }
}

Real StartMeshes::overlap(const StartMesh& mesh, Vec3 p, Real radius) const {
  const Vec3 q = in_periodic_box(space_, p);
  Real largest = 0;
  for (const Vec3 shift : shifts_) largest = std::max(largest, mesh.overlap(q + shift, radius));
  return largest;
}

bool StartMeshes::is_clear(Vec3 p, Real radius, Real gap) const {
  return std::ranges::all_of(meshes_,
                             [&](const StartMesh& mesh) { return !(overlap(mesh, p, radius + gap) > 0); });
}

}  // namespace scree
