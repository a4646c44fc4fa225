#include "dem/surfaces/surfaces.hpp"

#include <algorithm>

#include "mesh/surface_mesh.hpp"

namespace scree {

bool has_open_surfaces(const Model& model) {
  return std::ranges::any_of(model.meshes, [](const ModelMesh& mesh) { return mesh.surface->sheet; });
}

std::vector<WallPlane> wall_planes(const Model& model) {
  std::vector<WallPlane> planes;
  const SurfaceSet surfaces(model);
  for (const Wall& wall : model.walls) planes.push_back({wall.point, wall.normal, wall.material});
  for (Index s = 0; s < surfaces.placed(); ++s)
    if (!surfaces.is_on_body(s)) planes[static_cast<std::size_t>(surfaces.number_of(s))].placed = s;
  return planes;
}

SurfaceSet::SurfaceSet(const Model& model)
    : ground_(static_cast<Index>(model.walls.size())),
      parents_(model.bodies.size()),
      all_static_(model.bodies.empty()) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Shape& shape : model.bodies[b].shapes)
      surfaces_.push_back(
          {SurfaceKind::sphere, static_cast<int>(b), shape.material, shape.offset, {}, shape.radius});
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes)
      surfaces_.push_back(
          {SurfaceKind::mesh, static_cast<int>(b), shape.material, shape.offset, {}, 0, shape.mesh});
  on_bodies_ = placed();
  for (Index w = 0; w < ground_; ++w) {
    const Wall& wall = model.walls[static_cast<std::size_t>(w)];
    if (!wall.has_pose()) continue;
    if (wall.moves() || wall.is_conveyor()) all_static_ = false;
    surfaces_.push_back({wall.mesh < 0 ? SurfaceKind::plane : SurfaceKind::mesh, static_cast<int>(parents_++),
                         wall.material, wall.point, wall.normal, 0, wall.mesh, wall.moves()});
    walls_.push_back(w);
  }
}

Index SurfaceSet::posed_mesh(const Model& model, int body, int mesh) {
  std::size_t placed = 0;
  for (const Body& of : model.bodies) placed += of.shapes.size();
  for (int b = 0; b < body; ++b) placed += model.bodies[static_cast<std::size_t>(b)].meshes.size();
  return static_cast<Index>(placed) + mesh;
}

}  // namespace scree
