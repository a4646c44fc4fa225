// Sums over the particles in a region against a loop over the output of all particles.
#include <cmath>

#include "random_box.hpp"

namespace scree {
namespace {

RegionBounds box_region(Vec3 min, Vec3 max) {
  RegionBounds bounds;
  bounds.kind = RegionKind::box, bounds.min = min, bounds.max = max;
  return bounds;
}

RegionBounds round_region(RegionKind kind, Vec3 center, Vec3 axis, Real radius) {
  RegionBounds bounds;
  bounds.kind = kind, bounds.center = center, bounds.axis = axis, bounds.radius = radius;
  return bounds;
}

// The same geometry by distances.
bool holds(const RegionBounds& of, Vec3 p) {
  const auto between = [](Real low, Real x, Real high) { return low <= x && x <= high; };
  if (of.kind == RegionKind::box)
    return between(of.min.x, p.x, of.max.x) && between(of.min.y, p.y, of.max.y) &&
           between(of.min.z, p.z, of.max.z);
  const Vec3 arm = p - of.center;
  if (of.kind == RegionKind::sphere) return norm(arm) <= of.radius;
  const Real length = norm(of.axis), along = dot(arm, of.axis) / length;
  return between(0, along, length) && norm(arm - along / length * of.axis) <= of.radius;
}

}  // namespace

TEST_CASE("a region has the particles whose centres are in it") {
  const std::vector<RegionBounds> regions = {
      box_region({-0.5, -0.5, 0}, {0.7, 0.3, 1.1}), box_region({5, 5, 5}, {6, 6, 6}),
      round_region(RegionKind::sphere, {0.1, 0.2, 0.8}, {}, 0.9),
      round_region(RegionKind::cylinder, {-0.6, -0.4, 0.4}, {0.9, 0.7, 0.8}, 0.5)};
  for (const BoxCase& c : {kBoxes[0], kBoxes[1], kBoxes[4], kBoxes[6]}) {
    CAPTURE(c.name);
    LoadedBox box(random_box(c, 300, 7));
    for (Particle& record : box.records) record.position.x += 0.7;  // some move out of the periodic box
    box.backend->particles().load(box.records, {});
    box.backend->list().build(0.02, box.timers);
    box.backend->particles().initial_forces();
    const BoxOutput output(*box.backend);
    for (const RegionBounds& region : regions) {
      if (c.dimension == 2 && region.kind == RegionKind::cylinder) continue;
      Real number = 0, mass = 0;
      for (std::size_t i = 0; i < output.all.global_id.size(); ++i)
        if (holds(region, output.all.position[i])) number += 1, mass += output.of<Real>("mass")[i];
      const RegionSums sums = box.backend->reports().in_region(region);
      CHECK(sums.number == number);
      CHECK(std::abs(sums.mass - mass) <= 1e-12 * mass);
      CHECK((number > 0) == (region.min.x < 5));
    }
  }
}

TEST_CASE("a region has no escaped particles") {
  LoadedBox box(random_box(kBoxes[0], 50, 3));
  const RegionBounds all = box_region({-9, -9, -9}, {9, 9, 9});
  for (Particle& record : box.records)
    if (record.global_id % 5 == 0) record.drifting = 1;
  box.backend->particles().load(box.records, {});
  CHECK(box.backend->reports().in_region(all).number == 40);
}

}  // namespace scree
