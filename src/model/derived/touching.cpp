#include "model/derived/touching.hpp"

#include <algorithm>

#include "model/derived/connections.hpp"

namespace scree {

bool collides(const DeckTable& body, const DeckTable& surface) {
  return body.boolean("collides") && surface.boolean("collides");
}

RadiusRange radius_range(const Model& model) {
  const ParticleTotals& particles = model.particles.totals;
  std::vector<Real> radii;
  if (particles.count > 0) radii = {particles.smallest_radius, particles.largest_radius};
  for (const Body& body : model.bodies)
    for (const Shape& shape : body.shapes) radii.push_back(shape.radius);
  if (radii.empty()) return {};
  const auto [smallest, largest] = std::minmax_element(radii.begin(), radii.end());
  return {*smallest, *largest};
}

TouchRule::TouchRule(const Model& model) : apart_(model.bodies.size()) {
  const auto shaped = [&](std::size_t body) { return !model.bodies[body].shapes.empty(); };
  if (!model.contact.connected_bodies_touch) {
    for (const auto& [a, b] : connected_bodies(model)) {
      apart_[static_cast<std::size_t>(a)].push_back(b);
      apart_[static_cast<std::size_t>(b)].push_back(a);
    }
  }
  std::int64_t bodies = 0, apart = 0;  // bodies with shapes; pairs of them, each counted from both sides
  for (std::size_t b = 0; b < apart_.size(); ++b) {
    std::sort(apart_[b].begin(), apart_[b].end());
    if (!shaped(b)) continue;
    ++bodies;
    apart += std::count_if(apart_[b].begin(), apart_[b].end(),
                           [&](int other) { return shaped(static_cast<std::size_t>(other)); });
  }
  bodies_may_touch_ = apart < bodies * (bodies - 1);
}

bool TouchRule::may_touch(int body_a, int body_b) const {
  if (body_a == kGround || body_b == kGround) return true;
  if (body_a == body_b) return false;
  const std::vector<int>& apart = excluded_bodies(body_a);
  return !std::binary_search(apart.begin(), apart.end(), body_b);
}

}  // namespace scree
