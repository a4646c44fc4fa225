#include "model/data/particles.hpp"

#include <algorithm>
#include <bit>

namespace scree {
namespace {

// Extremes of this rank's values; those of all ranks are found as maxima of non-negative numbers.
struct Extremes {
  Real smallest = kInfinity, largest = 0;
  void add(Real value) { smallest = std::min(smallest, value), largest = std::max(largest, value); }
};

// The bits of positive numbers have the order of the numbers.
Real smallest_of_all(const Share& share, Real value) {
  const Real smallest = std::bit_cast<Real>(share.min(std::bit_cast<std::int64_t>(value)));
  return smallest < kInfinity ? smallest : 0;
}

}  // namespace

std::vector<int> groups_of(const ParticleSet& particles, std::span<const GlobalId> ids) {
  const std::vector<ParticleGroup>& groups = particles.groups;
  const std::int64_t at_start = particles.totals.at_start, in_deck = std::ssize(groups) - particles.inserters;
  std::vector<int> numbers;
  numbers.reserve(ids.size());
  int group = 0;
  for (const GlobalId id : ids) {
    if (id >= at_start && particles.inserters > 0) {
      numbers.push_back(static_cast<int>(in_deck + (id - at_start) % particles.inserters));
      continue;
    }
    while (group + 1 < in_deck && groups[static_cast<std::size_t>(group) + 1].first_id <= id) ++group;
    numbers.push_back(group);
  }
  return numbers;
}

void add_births(ParticleTotals& totals, const BornParticles& born) {
  const bool first = totals.largest_radius == 0;
  const auto widen = [first](Real& smallest, Real& largest, Real low, Real high) {
    smallest = first ? low : std::min(smallest, low), largest = std::max(largest, high);
  };
  widen(totals.smallest_radius, totals.largest_radius, born.smallest_radius, born.largest_radius);
  widen(totals.smallest_mass, totals.largest_mass, born.smallest_mass, born.largest_mass);
  widen(totals.smallest_density, totals.largest_density, born.smallest_density, born.largest_density);
  totals.most_radii_per_second =
      std::max(totals.most_radii_per_second, born.most_speed / born.smallest_radius);
  for (Real Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
    widen(totals.lowest.*axis, totals.highest.*axis, born.lowest.*axis, born.highest.*axis);
  ParticleTotals::OfMaterial& of = totals.materials[static_cast<std::size_t>(born.material)];
  const auto smaller = [&of](Real& smallest, Real value) {
    smallest = of.count == 0 ? value : std::min(smallest, value);
  };
  smaller(of.smallest_radius, born.smallest_radius), smaller(of.smallest_mass, born.smallest_mass);
  smaller(of.smallest_inertia_factor, born.smallest_inertia_factor);
  of.count += born.count;
}

void count_particles(ParticleSet& particles, int materials, const Share& share) {
  ParticleTotals totals;
  const auto slots = static_cast<std::size_t>(materials);
  Extremes radius, mass, density, radii_per_second;
  std::vector<std::int64_t> count(slots);
  std::vector<Extremes> radius_of(slots), mass_of(slots), factor_of(slots);
  Vec3 low{kInfinity, kInfinity, kInfinity}, high = -low;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto material = static_cast<std::size_t>(particles.material[i]);
    radius.add(particles.radius[i]), mass.add(particles.mass[i]), ++count[material];
    density.add(particles.mass[i] / sphere_mass(particles.radius[i], 1));
    radii_per_second.add(norm(particles.velocity[i]) / particles.radius[i]);
    const Vec3 p = particles.position[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    radius_of[material].add(particles.radius[i]), mass_of[material].add(particles.mass[i]);
    factor_of[material].add(particles.inertia_factor_of(i));
  }
  totals.at_start = totals.count = share.sum(static_cast<std::int64_t>(particles.size()));
  totals.smallest_radius = smallest_of_all(share, radius.smallest);
  totals.largest_radius = share.max(radius.largest);
  totals.smallest_mass = smallest_of_all(share, mass.smallest);
  totals.largest_mass = share.max(mass.largest);
  totals.smallest_density = smallest_of_all(share, density.smallest);
  totals.largest_density = share.max(density.largest);
  totals.most_radii_per_second = share.max(radii_per_second.largest);
  low = {-share.max(-low.x), -share.max(-low.y), -share.max(-low.z)};
  high = {share.max(high.x), share.max(high.y), share.max(high.z)};
  if (totals.count > 0) totals.lowest = low, totals.highest = high;
  for (std::size_t m = 0; m < slots; ++m)
    totals.materials.push_back({share.sum(count[m]), smallest_of_all(share, radius_of[m].smallest),
                                smallest_of_all(share, mass_of[m].smallest),
                                smallest_of_all(share, factor_of[m].smallest)});
  particles.totals = std::move(totals);
}

}  // namespace scree
