#include "dem/surfaces.hpp"

namespace scree {

std::vector<WallPlane> wall_planes(const Model& model) {
  std::vector<WallPlane> planes;
  for (const Wall& wall : model.walls) planes.push_back({wall.point, wall.normal, wall.material});
  return planes;
}

SurfaceSet::SurfaceSet(const Model& model) : ground_(static_cast<Index>(model.walls.size())) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Shape& shape : model.bodies[b].shapes)
      on_bodies_.push_back(
          {SurfaceKind::sphere, static_cast<int>(b), shape.material, shape.offset, {}, shape.radius});
}

}  // namespace scree
