#include "dem/particles/particle_store.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "base/error.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

Index count_on_rank(std::size_t particles, const ParticleTotals& of_all) {
  if (static_cast<std::int64_t>(particles) > of_all.count)
    throw std::logic_error("count_on_rank: the particles were not counted");
  constexpr Index kMost = std::numeric_limits<Index>::max();
  if (particles > static_cast<std::size_t>(kMost))
    throw InputError(std::to_string(particles) + " particles on one rank; a rank can have at most " +
                     std::to_string(kMost) + ": more ranks are needed");
  return static_cast<Index>(particles);
}

void ParticleStore::load(std::span<const Particle> records) {
  owned = active = static_cast<Index>(records.size());
  for_each_array<kAllArrays>(
      FieldsThere(*this), [&](auto& array) { array.resize(records.size()); }, *this);
  for (Index i = 0; i < owned; ++i) put_particle(*this, i, records[static_cast<std::size_t>(i)]);
}

void ParticleStore::add(const Particle& particle) {
  const auto n = static_cast<std::size_t>(owned) + 1;
  for_each_array<kAllArrays>(
      FieldsThere(*this), [&](auto& array) { array.resize(n); }, *this);
  put_particle(*this, owned++, particle);
}

std::vector<Particle> ParticleStore::records() const {
  std::vector<Particle> out;
  out.reserve(static_cast<std::size_t>(owned));
  for (Index i = 0; i < owned; ++i) out.push_back(particle_at(*this, i));
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.global_id < b.global_id; });
  return out;
}

void ParticleStore::reorder(const std::vector<Index>& from) {
  const auto permute = [&](auto& values) {
    std::decay_t<decltype(values)> sorted(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) sorted[i] = values[static_cast<std::size_t>(from[i])];
    values.swap(sorted);
  };
  for_each_array<kAllArrays>(FieldsThere(*this), permute, *this);
  owned = static_cast<Index>(from.size());
}

void ParticleStore::resize_items(Index items) {
  const auto n = static_cast<std::size_t>(items);
  for_each_array<kItemArrays>(
      FieldsThere(*this), [&](auto& array) { array.resize(n); }, *this);
}

std::vector<Particle> initial_records(const ParticleSet& set, const Subdomain& subdomain) {
  std::vector<Particle> records(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    Particle& p = records[i];
    p.global_id = set.first_id + static_cast<GlobalId>(i);
    p.position = subdomain.wrap(snap(set.position[i], subdomain.snap_constant()), p.image);
    p.image = {};
    p.velocity = set.velocity[i];
    if (!set.angular_velocity.empty()) p.angular_velocity = set.angular_velocity[i];
  }
  take_constants(set, records);
  return records;
}

void take_constants(const ParticleSet& set, std::span<Particle> records) {
  for (Particle& p : records) {
    if (p.global_id >= set.ids().last) continue;
    const auto at = static_cast<std::size_t>(p.global_id - set.first_id);
    p.radius = set.radius[at], p.mass = set.mass[at], p.material = set.material[at];
    p.moment_of_inertia = moment_of_inertia(set.inertia_factor_of(at), p.mass, p.radius);
  }
}

}  // namespace scree
