#include "run/report/surfaces_outside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.hpp"
#include "coupling/wall_motion.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/posed_meshes.hpp"
#include "model/derived/space_box.hpp"

namespace scree {
namespace {

constexpr int kInstants = 100;  // number of samples of a wall's motion
// Position of a sample within its interval, by the golden ratio, so that the samples do not match a period of
// the motion.
constexpr Real kGolden = 0.6180339887498949;
constexpr std::size_t kNamed = 3;  // parents in one warning

// Box of the open sides of the domain; its other sides are at infinity.
Box open_sides(const Space& space) {
  const Box all = open_box(space);
  Box open{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
  const auto take = [&](int side, Real Vec3::*along) {
    if (space.boundary[side] == Boundary::open) open.min.*along = all.min.*along;
    if (space.boundary[side + 1] == Boundary::open) open.max.*along = all.max.*along;
  };
  take(kXMin, &Vec3::x), take(kYMin, &Vec3::y), take(kZMin, &Vec3::z);
  return open;
}

bool particles_may_leave(const Model& model) {
  return model.particles.totals.count > 0 && model.space.leaving != OutsidePolicy::error;
}

// Calls visit(point, radius) for spheres and vertices, in the parent's frame, whose hull contains the
// parent's surfaces.
template <class Visit>
void for_each_extreme(const Model& model, const Body& body, const Visit& visit) {
  for (const Shape& shape : body.shapes) visit(shape.offset, shape.radius);
  for (const MeshShape& shape : body.meshes)
    for (const Vec3 v : model.meshes[as_size(shape.mesh)].surface->vertices) visit(shape.offset + v, Real(0));
}

template <class Visit>
void for_each_extreme(const Model& model, const Wall& wall, const Visit& visit) {
  if (wall.mesh < 0) return;
  for (const Vec3 v : model.meshes[as_size(wall.mesh)].surface->vertices) visit(wall.point + v, Real(0));
}

// Whether a surface is beyond an open side. 2D lines extend along z, where their domain has no sides.
template <class Parent>
bool extends_beyond(const Model& model, const Parent& parent, const BodyMotion& motion, const Box& open) {
  const Mat3 axes = rotation_matrix(orientation(motion));
  bool beyond = false;
  for_each_extreme(model, parent, [&](Vec3 offset, Real radius) {
    beyond |= !open.inside(motion.position + axes * offset, radius);
  });
  return beyond;
}

// The bounding box of the boxes added.
class BoxAround {
 public:
  void add(Vec3 low, Vec3 high) {
    box_.min = {std::min(box_.min.x, low.x), std::min(box_.min.y, low.y), std::min(box_.min.z, low.z)};
    box_.max = {std::max(box_.max.x, high.x), std::max(box_.max.y, high.y), std::max(box_.max.z, high.z)};
  }
  void add(const Model& model, int mesh, Vec3 offset) {
    const MeshBox& of_mesh = model.meshes[as_size(mesh)].surface->box;
    add(offset + of_mesh.min, offset + of_mesh.max);
  }
  std::optional<Box> box() const { return box_.min.x <= box_.max.x ? std::optional(box_) : std::nullopt; }

 private:
  Box box_{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
};

std::optional<Box> box_of(const Model& model, const Body& body) {
  BoxAround around;
  for (const Shape& shape : body.shapes) {
    const Vec3 r{shape.radius, shape.radius, shape.radius};
    around.add(shape.offset - r, shape.offset + r);
  }
  for (const MeshShape& shape : body.meshes) around.add(model, shape.mesh, shape.offset);
  return around.box();
}

std::optional<Box> box_of(const Model& model, const Wall& wall) {
  BoxAround around;
  if (wall.mesh >= 0) around.add(model, wall.mesh, wall.point);
  return around.box();
}

std::string body_text(const Body& body) { return fmt::format("body \"{}\"", body.name); }
std::string wall_text(const Wall& wall) { return fmt::format("wall \"{}\"", wall.name); }

// Placed walls, in their order, that are beyond an open side at any sampled instant.
std::vector<std::string> walls_beyond(const Model& model, const Box& open) {
  const WallMotions motions(model);
  std::vector<const Wall*> placed;
  for (const Wall& wall : model.walls)
    if (wall.has_pose()) placed.push_back(&wall);
  std::vector<bool> beyond(placed.size());
  std::vector<BodyMotion> motion(placed.size());
  for (int k = 0; k <= kInstants; ++k) {
    const Real share = k < kInstants ? (k + std::fmod(k * kGolden, 1)) / kInstants : 1;
    motions.at(share * model.time.end, motion);
    for (std::size_t w = 0; w < placed.size(); ++w)
      if (!beyond[w] && (k == 0 || placed[w]->moves()))
        beyond[w] = extends_beyond(model, *placed[w], motion[w], open);
  }
  std::vector<std::string> texts;
  for (std::size_t w = 0; w < placed.size(); ++w)
    if (beyond[w]) texts.push_back(wall_text(*placed[w]));
  return texts;
}

std::string consequence(const Model& model) {
  return model.space.leaving == OutsidePolicy::remove
             ? "are removed"
             : "are excluded from contact detection, so that no surface holds them";
}

// The periodic image of p nearest to `middle` [m].
Vec3 nearest_image(Vec3 middle, Vec3 p, Vec3 periods) {
  const auto along = [](Real m, Real x, Real period) {
    return period > 0 ? x - std::round((x - m) / period) * period : x;
  };
  return {along(middle.x, p.x, periods.x), along(middle.y, p.y, periods.y), along(middle.z, p.z, periods.z)};
}

}  // namespace

std::string outside_at_start(const Model& model) {
  if (!particles_may_leave(model)) return "";
  const Box open = open_sides(model.space);
  std::vector<std::string> beyond;
  for (const Body& body : model.bodies)
    if (extends_beyond(model, body, start_motion(body), open)) beyond.push_back(body_text(body));
  for (std::string& text : walls_beyond(model, open)) beyond.push_back(std::move(text));
  if (beyond.empty()) return "";
  std::string names;
  for (std::size_t k = 0; k < std::min(beyond.size(), kNamed); ++k) names += (k == 0 ? "" : ", ") + beyond[k];
  if (beyond.size() > kNamed) names += fmt::format(" and {} more", beyond.size() - kNamed);
  return fmt::format(
      "{} {} beyond an open side of the domain: particles that leave there {}; a larger domain keeps them",
      names, beyond.size() > 1 ? "reach" : "reaches", consequence(model));
}

SurfacesOutside::SurfacesOutside(const Model& model) : model_(model) {
  if (!particles_may_leave(model)) return;
  for (const Body& body : model.bodies)
    boxes_.push_back(box_of(model, body)), names_.push_back(body_text(body));
  for (const Wall& wall : model.walls)
    if (wall.has_pose()) boxes_.push_back(box_of(model, wall)), names_.push_back(wall_text(wall));
}

std::string SurfacesOutside::warning(std::span<const EscapedParticle> escaped_particles,
                                     std::span<const BodyMotion> motion, Real t) const {
  const Real diameter = 2 * model_.particles.totals.largest_radius;
  const Vec3 periods = periods_of(model_.space);
  for (std::size_t c = 0; c < boxes_.size(); ++c) {
    if (!boxes_[c]) continue;
    const Box& box = *boxes_[c];
    const Mat3 axes = rotation_matrix(orientation(motion[c]));
    const Vec3 middle = motion[c].position + axes * (Real(0.5) * (box.min + box.max));
    for (const EscapedParticle& escaped_particle : escaped_particles) {
      const Vec3 place = nearest_image(middle, escaped_particle.position, periods) - motion[c].position;
      if (!box.is_within(transposed_times(axes, place), diameter)) continue;
      return fmt::format(
          "particle {} leaves the domain at t = {:.6g} s at the surfaces of {}: particles that leave {}; a "
          "larger domain keeps them",
          escaped_particle.global_id, t, names_[c], consequence(model_));
    }
  }
  return "";
}

}  // namespace scree
