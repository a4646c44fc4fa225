#include "model/derived/mesh_corners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/mat3.hpp"
#include "mesh/hull_corners.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/connections.hpp"
#include "physics/step_limits.hpp"

namespace scree {
namespace {

bool is_plane(const Wall& wall) { return wall.mesh < 0; }

const HullCorners* corners_of(const Model& model, const MeshShape& shape) {
  return model.meshes[static_cast<std::size_t>(shape.mesh)].corners.get();
}

constexpr int kMotions = 6;  // displacements, then rotations of a body
using Motion = std::array<Real, kMotions>;

// Mobility of a body's point in a direction: the body's motions divided by the root of their inertia. A
// spring there adds this vector times its transpose, times the stiffness, to the matrix of squared
// frequencies [kg^-1/2].
Motion mobility(const Body& body, Vec3 arm, Vec3 direction) {
  const Vec3 lever = cross(arm, direction);
  const Real move = 1 / std::sqrt(body.mass), turn = 1 / std::sqrt(body.inertia);
  if (body.kind == BodyKind::planar) return {move * direction.x, move * direction.y, 0, 0, 0, turn * lever.z};
  return {move * direction.x, move * direction.y, move * direction.z,
          turn * lever.x,     turn * lever.y,     turn * lever.z};
}

Real product(const Motion& a, const Motion& b) {
  Real sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

// Largest eigenvalue of the sum of a a^T, computed where it may exceed `least`; it is at most the trace.
// Power method from the longest of the vectors, which converges from below, to one per cent, with the trace
// as upper bound.
Real largest_eigenvalue(const std::vector<Motion>& rows, Real least) {
  constexpr int kIterations = 60;
  Real trace = 0;
  Motion x{};
  for (const Motion& row : rows) {
    trace += product(row, row);
    if (product(row, row) > product(x, x)) x = row;
  }
  if (trace <= least) return 0;
  for (int k = 0; k < kIterations; ++k) {
    Motion next{};
    for (const Motion& row : rows) {
      const Real along = product(row, x);
      for (std::size_t j = 0; j < next.size(); ++j) next[j] += along * row[j];
    }
    const Real size = std::sqrt(product(next, next));
    for (std::size_t j = 0; j < next.size(); ++j) x[j] = next[j] / size;
  }
  Real value = 0;
  for (const Motion& row : rows) value += product(row, x) * product(row, x);
  return value;
}

// Inverse effective masses of a body on its vertices [1/kg]: for forces along a plane's normal, and for
// tangential friction.
struct InverseMasses {
  Real pushed = 0, frictional = 0;
};

InverseMasses inverse_masses(const Body& body, const MeshShape& shape, const HullCorners& hull) {
  InverseMasses most;
  for (const Vec3 corner : hull.corners) {
    const Vec3 place = shape.offset + corner;
    const Real lever =
        body.kind == BodyKind::planar ? place.x * place.x + place.y * place.y : dot(place, place);
    most.pushed = std::max(most.pushed, 1 / body.mass + lever / body.inertia);
  }
  most.frictional = most.pushed;
  for (Index face = 0; face < hull.faces(); ++face) {
    const Vec3 normal = hull.normals[static_cast<std::size_t>(face)];
    const Vec3 axis = std::abs(normal.x) > Real(0.6) ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 across = cross(normal, axis), along = (1 / norm(across)) * across;
    std::vector<Motion> pushes, has_friction;
    for (const Index corner : hull.of_face(face)) {
      const Vec3 place = shape.offset + hull.corners[static_cast<std::size_t>(corner)];
      pushes.push_back(mobility(body, place, normal));
      for (const Vec3 direction : {along, cross(normal, along)})
        has_friction.push_back(mobility(body, place, direction));
    }
    most.pushed = std::max(most.pushed, largest_eigenvalue(pushes, most.pushed));
    most.frictional = std::max(most.frictional, largest_eigenvalue(has_friction, most.frictional));
  }
  return most;
}

}  // namespace

void build_mesh_corners(Model& model) {
  if (std::ranges::none_of(model.walls, is_plane)) return;
  for (const Body& body : model.bodies)
    for (const MeshShape& shape : body.meshes) {
      ModelMesh& mesh = model.meshes[static_cast<std::size_t>(shape.mesh)];
      if (mesh.corners == nullptr)
        mesh.corners = std::make_shared<const HullCorners>(
            hull_corners(mesh.surface->vertices, model.space.dimension == 2));
    }
}

// Limit: the overlap that contacts may have at t = 0 by default.
const Wall* plane_across(const Model& model, std::size_t body, const MeshShape& shape) {
  constexpr Real kMostOverlap = 0.05;  // relative to the effective radius
  const HullCorners* const hull = corners_of(model, shape);
  if (hull == nullptr) return nullptr;
  const auto is_across = [&](const Wall& wall) {
    return is_plane(wall) && std::ranges::any_of(hull->corners, [&](Vec3 corner) {
             const Vec3 place = to_global_point(model, static_cast<int>(body), shape.offset + corner);
             return dot(wall.normal, place - wall.point) < -kMostOverlap * hull->radius;
           });
  };
  const auto wall = std::ranges::find_if(model.walls, is_across);
  return wall == model.walls.end() ? nullptr : &*wall;
}

bool may_touch_planes(const Model& model, std::size_t body, const MeshShape& shape) {
  return corners_of(model, shape) != nullptr &&
         (plane_across(model, body, shape) == nullptr || !held_bodies(model)[body]);
}

bool touches_planes(const Model& model, std::size_t body, const MeshShape& shape) {
  return may_touch_planes(model, body, shape) && std::ranges::any_of(model.walls, [&](const Wall& wall) {
           return is_plane(wall) && model.contact.law(shape.material, wall.material).acts();
         });
}

void warn_of_meshes_across(const Model& model, Log& log) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes) {
      const Wall* const wall = plane_across(model, b, shape);
      if (wall == nullptr || may_touch_planes(model, b, shape) ||
          !model.contact.law(shape.material, wall->material).acts())
        continue;
      log.warning(fmt::format(
          "body \"{}\": its mesh \"{}\" lies across wall \"{}\" at t = 0, and joints hold the body: the mesh "
          "touches no planes",
          model.bodies[b].name, model.meshes[static_cast<std::size_t>(shape.mesh)].name, wall->name));
    }
}

Real largest_corner_radius(const Model& model) {
  Real largest = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes)
      if (touches_planes(model, b, shape)) largest = std::max(largest, corners_of(model, shape)->radius);
  return largest;
}

CornerOscillation fastest_on_corners(const Model& model, bool held) {
  CornerOscillation fastest;
  const std::vector<bool> is_held = held_bodies(model), prescribed = prescribed_bodies(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes) {
      if (is_held[b] != held || prescribed[b] || !touches_planes(model, b, shape)) continue;
      const Body& body = model.bodies[b];
      const HullCorners& hull = *corners_of(model, shape);
      const InverseMasses masses = inverse_masses(body, shape, hull);
      const PairSize size{hull.radius, kInfinity, body.mass, kInfinity};
      for (const Wall& wall : model.walls) {
        const NormalLawParameters& law = model.contact.law(shape.material, wall.material);
        if (!is_plane(wall) || !law.acts()) continue;
        Real frequency = contact_frequency(typical_stiffness(law, size), 1 / masses.pushed);
        if (model.rotates()) {
          const Friction friction = model.contact.friction_of(shape.material, wall.material);
          frequency = std::max(
              frequency, contact_frequency(typical_slip_stiffness(friction, size), 1 / masses.frictional));
        }
        if (frequency > fastest.frequency) fastest = {frequency, law_of_size(law, size).exponent == 1};
      }
    }
  return fastest;
}

}  // namespace scree
