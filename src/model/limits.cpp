#include "model/limits.hpp"

#include <algorithm>

#include "model/touching.hpp"
#include "physics/step_limits.hpp"

namespace scree {

namespace {

void take_smaller(Real& smallest, Real value) {
  if (smallest == 0 || value < smallest) smallest = value;
}

// Smallest mass of the relative motion of something of use a against something of use b [kg]; walls do not
// move.
Real smallest_reduced_mass(const MaterialUse& a, const MaterialUse& b) {
  const auto lightest = [](const MaterialUse& use) {
    if (use.smallest_particle_mass == 0) return use.smallest_body_mass;
    if (use.smallest_body_mass == 0) return use.smallest_particle_mass;
    return std::min(use.smallest_particle_mass, use.smallest_body_mass);
  };
  const Real mass_a = lightest(a), mass_b = lightest(b);
  if (mass_a == 0 || mass_b == 0) return std::max(mass_a, mass_b);
  return reduced_mass(mass_a, mass_b);
}

Real smaller_radius(const MaterialUse& a, const MaterialUse& b) {
  if (a.smallest_radius == 0 || b.smallest_radius == 0) return std::max(a.smallest_radius, b.smallest_radius);
  return std::min(a.smallest_radius, b.smallest_radius);
}

// Of the lightest particle of use `use`: in a dense packing of such particles, or, where the other material
// has none, at a wall or body.
Real explicit_step(const Model& model, const MaterialUse& use, bool dense, const KelvinVoigt& law,
                   Real stiffness) {
  if (use.particles == 0) return 0;
  const Real mass = use.smallest_particle_mass;
  const Real frequency =
      dense ? dense_frequency(stiffness, mass, model.space.dimension) : contact_frequency(stiffness, mass);
  return verlet_step_limit(frequency, stiffness, law.normal_damping);
}

}  // namespace

std::vector<MaterialUse> material_uses(const Model& model) {
  std::vector<MaterialUse> uses(static_cast<std::size_t>(model.contact.materials()));
  for (std::size_t m = 0; m < uses.size(); ++m) {
    const ParticleTotals::OfMaterial& particles = model.particles.totals.materials[m];
    uses[m].particles = particles.count;
    uses[m].smallest_radius = particles.smallest_radius;
    uses[m].smallest_particle_mass = particles.smallest_mass;
  }
  for (const Body& body : model.bodies) {
    for (const Shape& shape : body.shapes) {
      MaterialUse& use = uses[static_cast<std::size_t>(shape.material)];
      ++use.shapes;
      take_smaller(use.smallest_radius, shape.radius);
      take_smaller(use.smallest_body_mass,
                   1 / (1 / body.mass + dot(shape.offset, shape.offset) / body.inertia));
    }
  }
  for (const Wall& wall : model.walls) ++uses[static_cast<std::size_t>(wall.material)].walls;
  return uses;
}

bool can_meet(const Model& model, const std::vector<MaterialUse>& uses, int a, int b) {
  const MaterialUse &first = uses[static_cast<std::size_t>(a)], &second = uses[static_cast<std::size_t>(b)];
  const auto moving = [](const MaterialUse& use) { return use.particles + use.shapes; };
  if (first.walls > 0 && moving(second) > 0) return true;
  if (second.walls > 0 && moving(first) > 0) return true;
  if (first.particles > 0 && second.shapes > 0) return true;
  if (second.particles > 0 && first.shapes > 0) return true;
  if (a == b ? first.particles > 1 : first.particles > 0 && second.particles > 0) return true;
  return first.shapes > 0 && second.shapes > 0 && TouchRule(model).bodies_may_touch();
}

std::vector<PairLimit> pair_limits(const Model& model) {
  const std::vector<MaterialUse> uses = material_uses(model);
  std::vector<PairLimit> limits;
  for (int a = 0; a < model.contact.materials(); ++a) {
    for (int b = a; b < model.contact.materials(); ++b) {
      const KelvinVoigt& law = model.contact.law(a, b);
      if (!can_meet(model, uses, a, b) || law.normal_stiffness == 0) continue;
      const MaterialUse &first = uses[static_cast<std::size_t>(a)],
                        &second = uses[static_cast<std::size_t>(b)];
      const Real stiffness = typical_stiffness(law, smaller_radius(first, second));
      const bool dense = first.particles > 0 && second.particles > 0;
      const Real step_a = explicit_step(model, first, dense, law, stiffness);
      const Real step_b = explicit_step(model, second, dense, law, stiffness);
      limits.push_back({{a, b},
                        law,
                        stiffness,
                        contact_time(stiffness, smallest_reduced_mass(first, second)),
                        step_a > 0 && step_b > 0 ? std::min(step_a, step_b) : std::max(step_a, step_b)});
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
