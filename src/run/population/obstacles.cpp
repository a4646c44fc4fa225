#include "run/population/obstacles.hpp"

#include <algorithm>

namespace scree {

Obstacles::Obstacles(const Model& model, std::span<const BodyMotion> motion)
    : subdomain_(model.space), shifts_(image_shifts(subdomain_.period())), meshes_(model, motion) {
  std::size_t parent = model.bodies.size();
  for (const Wall& wall : model.walls) {
    Plane plane{wall.point, wall.normal};
    if (wall.has_pose()) {
      const BodyMotion& of = motion[parent++];
      plane = {of.position, rotation_matrix(orientation(of)) * wall.normal};
    }
    if (wall.mesh < 0) planes_.push_back(plane);
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Shape& shape : model.bodies[b].shapes)
      spheres_.push_back(
          {in_periodic_box(model.space, point_motion(motion[b], shape.offset).position), shape.radius});
}

bool Obstacles::is_clear(Vec3 p, Real radius, Real gap) const {
  const Real distance = radius + gap;
  const auto overlaps = [&](const Sphere& sphere) {
    return std::ranges::any_of(shifts_, [&](Vec3 shift) {
      const Vec3 d = p + shift - sphere.center;
      return dot(d, d) < (distance + sphere.radius) * (distance + sphere.radius);
    });
  };
  const auto is_beyond = [&](const Plane& plane) { return dot(plane.normal, p - plane.point) < distance; };
  return subdomain_.inside(p) && std::ranges::none_of(planes_, is_beyond) &&
         std::ranges::none_of(spheres_, overlaps) && meshes_.is_clear(p, radius, gap);
}

}  // namespace scree
