#include "model/checks/limits.hpp"

#include <algorithm>

#include "mesh/hull_corners.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/mesh_corners.hpp"
#include "model/derived/touching.hpp"
#include "physics/step_limits.hpp"

namespace scree {

namespace {

void take_smaller(Real& smallest, Real value) {
  if (smallest == 0 || value < smallest) smallest = value;
}

// Reduced mass [kg].
Real smallest_reduced_mass(const PairSize& size) {
  if (size.mass_i == kInfinity || size.mass_j == kInfinity) return std::min(size.mass_i, size.mass_j);
  return reduced_mass(size.mass_i, size.mass_j);
}

// Largest stiffnesses that a pair of materials causes for particles, as in PairLimit.
struct PairSprings {
  const NormalLawParameters& law;
  Friction friction;
  RollingParameters rolling;
  Real stiffness, slip_stiffness, rolling_stiffness;  // [N/m]
  Real smallest_radius;                               // [m]
};

// Springs and dashpots are taken at their highest modes; the worst case is that both belong to one mode.
Real frictional_step(const PairSprings& pair, const MaterialUse& use, int dimension, bool dense) {
  const Real mass = use.smallest_particle_mass, inertia_ratio = use.smallest_inertia_factor;
  const Real slip_mass = mass / ((dense ? 2 : 1) * (1 + 1 / inertia_ratio));
  const Real slip_damping = dashpot_of(pair.friction.damping_ratio, slip_mass, pair.slip_stiffness);
  const Real square = pair.smallest_radius * pair.smallest_radius;
  const Real rolling_inertia = (1 + inertia_ratio) * mass / (dense ? 2 : 1);  // over R^2 [kg]
  const Real rolling_damping =
      dashpot_of(pair.rolling.damping_ratio, rolling_inertia, pair.rolling_stiffness) +
      pair.rolling.damping / square;
  const auto highest = [&](Real along, Real across, Real rolling) {
    return dense ? dense_friction_frequency(along, across, mass, inertia_ratio, dimension, rolling)
                 : wall_friction_frequency(along, across, mass, inertia_ratio, rolling);
  };
  const Real root_of_decay = highest(pair.law.normal_damping, slip_damping, rolling_damping);
  return leapfrog_step_limit(highest(pair.stiffness, pair.slip_stiffness, pair.rolling_stiffness),
                             root_of_decay * root_of_decay);
}

// Step limit for the lightest particle of use `use`: in a dense packing of such particles or, where the other
// material has no particles, on a wall or body.
Real explicit_step(const Model& model, const MaterialUse& use, bool dense, const PairSprings& pair) {
  if (use.particles == 0) return 0;
  const Real mass = use.smallest_particle_mass;
  if (model.rotates()) return frictional_step(pair, use, model.space.dimension, dense);
  const Real frequency = dense ? dense_frequency(pair.stiffness, mass, model.space.dimension)
                               : contact_frequency(pair.stiffness, mass);
  return verlet_step_limit(frequency, pair.stiffness, pair.law.normal_damping);
}

template <class Parts>
bool has_material(const Parts& parts, int material) {
  return std::ranges::any_of(parts, [&](const auto& part) { return part.material == material; });
}

// Whether a body with a shape of material a may touch another body with a mesh of material b.
bool shapes_touch_meshes(const Model& model, int a, int b) {
  const TouchRule rule(model);
  const int bodies = static_cast<int>(model.bodies.size());
  const auto body = [&](int number) -> const Body& { return model.bodies[static_cast<std::size_t>(number)]; };
  std::vector<int> with_mesh;
  for (int j = 0; j < bodies; ++j)
    if (has_material(body(j).meshes, b)) with_mesh.push_back(j);
  for (int i = 0; i < bodies && !with_mesh.empty(); ++i)
    if (has_material(body(i).shapes, a) &&
        std::ranges::any_of(with_mesh, [&](int j) { return rule.may_touch(i, j); }))
      return true;
  return false;
}

// Whether shapes of one material may touch walls that are meshes of the other.
bool shapes_touch_walls(const Model& model, const MaterialUse& use, int material) {
  return use.shapes > 0 && std::ranges::any_of(model.walls, [&](const Wall& wall) {
           return wall.mesh >= 0 && wall.material == material;
         });
}

}  // namespace

Real farthest(const ModelMesh& mesh, Vec3 offset, int dimension) {
  Real squared = 0;
  for (const Vec3 vertex : mesh.surface->vertices) {
    Vec3 arm = offset + vertex;
    if (dimension == 2) arm.z = 0;
    squared = std::max(squared, dot(arm, arm));
  }
  return std::sqrt(squared);
}

std::vector<MaterialUse> material_uses(const Model& model) {
  std::vector<MaterialUse> uses(static_cast<std::size_t>(model.contact.materials()));
  for (std::size_t m = 0; m < uses.size(); ++m) {
    const ParticleTotals::OfMaterial& particles = model.particles.totals.materials[m];
    uses[m].particles = particles.count;
    uses[m].smallest_radius = particles.smallest_radius;
    uses[m].smallest_particle_mass = particles.smallest_mass;
    uses[m].smallest_inertia_factor = particles.smallest_inertia_factor;
  }
  const std::vector<bool> prescribed = prescribed_bodies(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (const Shape& shape : body.shapes) {
      MaterialUse& use = uses[static_cast<std::size_t>(shape.material)];
      ++use.shapes;
      take_smaller(use.smallest_radius, shape.radius);
      if (prescribed[b]) continue;
      const Real lever_arm = norm(shape.offset) + shape.radius;
      take_smaller(use.smallest_body_mass,
                   1 / (1 / body.mass + dot(shape.offset, shape.offset) / body.inertia));
      take_smaller(use.smallest_frictional_mass, 1 / (1 / body.mass + lever_arm * lever_arm / body.inertia));
    }
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes) {
      const Body& body = model.bodies[b];
      MaterialUse& use = uses[static_cast<std::size_t>(shape.material)];
      const ModelMesh& mesh = model.meshes[static_cast<std::size_t>(shape.mesh)];
      const Real arm = farthest(mesh, shape.offset, model.space.dimension);
      ++use.meshes;
      use.sheets += mesh.surface->sheet;
      if (may_touch_planes(model, b, shape))
        ++use.corners, take_smaller(use.smallest_corner_radius, mesh.corners->radius);
      if (prescribed[b]) continue;
      for (Real* mass : {&use.smallest_body_mass, &use.smallest_frictional_mass})
        take_smaller(*mass, 1 / (1 / body.mass + arm * arm / body.inertia));
    }
  for (const Wall& wall : model.walls) {
    MaterialUse& use = uses[static_cast<std::size_t>(wall.material)];
    ++(wall.mesh < 0 ? use.walls : use.meshes);
    use.sheets += wall.mesh >= 0 && model.meshes[static_cast<std::size_t>(wall.mesh)].surface->sheet;
  }
  return uses;
}

bool can_touch(const Model& model, const std::vector<MaterialUse>& uses, int a, int b) {
  const MaterialUse &first = uses[static_cast<std::size_t>(a)], &second = uses[static_cast<std::size_t>(b)];
  return must_have_law(model, uses, a, b) || (first.walls > 0 && second.corners > 0) ||
         (second.walls > 0 && first.corners > 0);
}

bool must_have_law(const Model& model, const std::vector<MaterialUse>& uses, int a, int b) {
  const MaterialUse &first = uses[static_cast<std::size_t>(a)], &second = uses[static_cast<std::size_t>(b)];
  if (first.walls > 0 && second.spheres() > 0) return true;
  if (second.walls > 0 && first.spheres() > 0) return true;
  if (first.particles > 0 && second.shapes + second.meshes > 0) return true;
  if (second.particles > 0 && first.shapes + first.meshes > 0) return true;
  if (a == b ? first.particles > 1 : first.particles > 0 && second.particles > 0) return true;
  return bodies_can_touch(model, uses, a, b) || shapes_touch_walls(model, first, b) ||
         shapes_touch_walls(model, second, a);
}

bool bodies_can_touch(const Model& model, const std::vector<MaterialUse>& uses, int a, int b) {
  const MaterialUse &first = uses[static_cast<std::size_t>(a)], &second = uses[static_cast<std::size_t>(b)];
  if (first.shapes > 0 && second.shapes > 0 && TouchRule(model).bodies_may_touch()) return true;
  return (first.shapes > 0 && second.meshes > 0 && shapes_touch_meshes(model, a, b)) ||
         (second.shapes > 0 && first.meshes > 0 && shapes_touch_meshes(model, b, a));
}

bool touch_open_surfaces_only(const std::vector<MaterialUse>& uses, int a, int b) {
  const MaterialUse &first = uses[static_cast<std::size_t>(a)], &second = uses[static_cast<std::size_t>(b)];
  const auto has_others = [](const MaterialUse& use) { return use.walls > 0 || use.meshes > use.sheets; };
  if (a == b ? first.spheres() > 1 : first.spheres() > 0 && second.spheres() > 0) return false;
  return !(first.spheres() > 0 && has_others(second)) && !(second.spheres() > 0 && has_others(first));
}

PairSize smallest_partners(const MaterialUse& a, const MaterialUse& b) {
  const auto given = [](Real value) { return value > 0 ? value : kInfinity; };
  const auto lightest = [&](const MaterialUse& use) {
    return std::min(given(use.smallest_particle_mass), given(use.smallest_body_mass));
  };
  const bool spheres = a.smallest_radius > 0 || b.smallest_radius > 0;
  const auto radius = [&](const MaterialUse& use) {
    return given(spheres ? use.smallest_radius : use.smallest_corner_radius);
  };
  return {radius(a), radius(b), lightest(a), lightest(b)};
}

std::vector<PairLimit> pair_limits(const Model& model) {
  const std::vector<MaterialUse> uses = material_uses(model);
  std::vector<PairLimit> limits;
  for (int a = 0; a < model.contact.materials(); ++a) {
    for (int b = a; b < model.contact.materials(); ++b) {
      const NormalLawParameters& law = model.contact.law(a, b);
      if (!can_touch(model, uses, a, b) || !law.acts()) continue;
      const MaterialUse &first = uses[static_cast<std::size_t>(a)],
                        &second = uses[static_cast<std::size_t>(b)];
      const PairSize size = smallest_partners(first, second);
      if (smallest_reduced_mass(size) == kInfinity) continue;  // both have infinite mass
      const NormalLawParameters sized = law_of_size(law, size);
      const Real stiffness = typical_stiffness(law, size);
      const bool dense = first.particles > 0 && second.particles > 0;
      const Friction friction = model.rotates() ? model.contact.friction_of(a, b) : Friction{};
      const RollingParameters rolling = model.contact.rolling_of(a, b);
      const PairSprings springs{sized,
                                friction,
                                rolling,
                                stiffness,
                                typical_slip_stiffness(friction, size),
                                typical_rolling_stiffness(rolling, size, loading_stiffness(law, size)),
                                std::min(size.radius_i, size.radius_j)};
      const Real step_a = explicit_step(model, first, dense, springs);
      const Real step_b = explicit_step(model, second, dense, springs);
      const Real mass = smallest_reduced_mass(size);
      limits.push_back({{a, b},
                        sized,
                        stiffness,
                        springs.slip_stiffness,
                        springs.rolling_stiffness,
                        contact_time(stiffness, mass),
                        step_a > 0 && step_b > 0 ? std::min(step_a, step_b) : std::max(step_a, step_b),
                        law.own->sticking_speed(size, mass),
                        law.own->longest_step(size, mass)});
    }
  }
  return limits;
}

std::optional<PairLimit> shortest_contact(const std::vector<PairLimit>& limits) {
  if (limits.empty()) return std::nullopt;
  return *std::min_element(limits.begin(), limits.end(), [](const PairLimit& a, const PairLimit& b) {
    return a.contact_time < b.contact_time;
  });
}

std::optional<PairLimit> smallest_explicit_step(const std::vector<PairLimit>& limits) {
  std::optional<PairLimit> smallest;
  for (const PairLimit& limit : limits) {
    const bool smaller = !smallest || limit.explicit_step < smallest->explicit_step;
    if (limit.explicit_step > 0 && smaller) smallest = limit;
  }
  return smallest;
}

}  // namespace scree
