#include "model/checks/impact_speed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "model/derived/surface_speeds.hpp"
#include "physics/plausible.hpp"

namespace scree {

Real fall_height(const Model& model) {
  const Vec3 g = model.gravity, extent = model.space.max - model.space.min;
  const Real size = norm(g);
  return size > 0 ? (std::abs(g.x) * extent.x + std::abs(g.y) * extent.y + std::abs(g.z) * extent.z) / size
                  : 0;
}

Real lightest_mass(const PairLimit& limit) {
  const Real inverse_frequency = limit.contact_time / std::numbers::pi_v<Real>;
  return limit.stiffness * inverse_frequency * inverse_frequency;
}

ImpactSpeeds::ImpactSpeeds(const Model& model)
    : model_(model), uses_(material_uses(model)), surfaces_(surface_speeds(model)) {
  fastest_ = surfaces_.empty() ? 0 : *std::ranges::max_element(surfaces_);
  floor_ = std::ranges::any_of(uses_, &MaterialUse::is_of_surfaces);
}

Real ImpactSpeeds::of(const PairLimit& limit) const {
  const auto a = static_cast<std::size_t>(limit.material[0]), b = static_cast<std::size_t>(limit.material[1]);
  const bool particles = uses_[a].particles + uses_[b].particles > 0;
  Real speed = 0;
  if (particles)
    speed = model_.particles.totals.most_radii_per_second * model_.particles.totals.smallest_radius;
  if (uses_[a].shapes + uses_[b].shapes + uses_[a].meshes + uses_[b].meshes > 0)
    for (const Body& body : model_.bodies) speed = std::max(speed, norm(body.velocity));
  // Particles fall onto particles that lie on a floor, of any material.
  if (floor_ && particles) speed = std::hypot(speed, fall_speed(norm(model_.gravity), fall_height(model_)));
  return speed + (particles ? fastest_ : std::max(surfaces_[a], surfaces_[b]));
}

Real unnoticed_step(const Model& model) {
  constexpr Real kShareOfRadius = 0.5;
  const ParticleTotals& particles = model.particles.totals;
  if (particles.count == 0) return kInfinity;
  const Vec3 extent = model.space.max - model.space.min, g = model.gravity;
  const Real fall = std::abs(g.x) * extent.x + std::abs(g.y) * extent.y + std::abs(g.z) * extent.z;
  const Real falling =
      std::hypot(particles.most_radii_per_second, std::sqrt(2 * fall) / particles.smallest_radius);
  const Real pushed = ImpactSpeeds(model).fastest_surface() / particles.smallest_radius;
  return kShareOfRadius / std::max(falling, pushed);
}

}  // namespace scree
