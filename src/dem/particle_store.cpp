#include "dem/particle_store.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/error.hpp"

namespace scree {

void ParticleStore::load(const ParticleSet& set, std::span<const ParticleRecord> records) {
  const std::size_t n = records.size();
  if (std::ssize(records) > set.totals.count)
    throw std::logic_error("ParticleStore::load: the particles were not counted");
  if (n > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw InputError(std::to_string(n) + " particles on one rank; a rank can have at most " +
                     std::to_string(std::numeric_limits<Index>::max()) + ": more ranks are needed");
  owned = active = static_cast<Index>(n);
  position.resize(n), velocity.resize(n), material.resize(n), global_id.resize(n);
  acceleration.resize(n), force.resize(n), image.resize(n), drifting.resize(n);
  contact_loss.resize(n), loss_power.resize(n), integrator_loss.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const ParticleRecord& r = records[i];
    const auto at = static_cast<std::size_t>(r.global_id - set.first_id);
    position[i] = vec4(r.position, set.radius[at]);
    velocity[i] = vec4(r.velocity, set.mass[at]);
    material[i] = set.material[at];
    global_id[i] = r.global_id;
    acceleration[i] = r.acceleration, force[i] = r.force;
    contact_loss[i] = r.contact_loss, loss_power[i] = r.loss_power, integrator_loss[i] = r.integrator_loss;
    image[i] = r.image, drifting[i] = r.drifting;
  }
}

ParticleRecord ParticleStore::record(Index at) const {
  const auto i = static_cast<std::size_t>(at);
  return {global_id[i],    xyz(position[i]), xyz(velocity[i]),   acceleration[i], force[i],
          contact_loss[i], loss_power[i],    integrator_loss[i], image[i],        drifting[i] != 0};
}

Migrant ParticleStore::migrant(Index at) const {
  const auto i = static_cast<std::size_t>(at);
  return {record(at), position[i].w, velocity[i].w, material[i]};
}

void ParticleStore::add(const Migrant& particle) {
  const ParticleRecord& r = particle.state;
  position.push_back(vec4(r.position, particle.radius)), velocity.push_back(vec4(r.velocity, particle.mass));
  material.push_back(static_cast<int>(particle.material)), global_id.push_back(r.global_id);
  acceleration.push_back(r.acceleration), force.push_back(r.force);
  contact_loss.push_back(r.contact_loss), loss_power.push_back(r.loss_power);
  integrator_loss.push_back(r.integrator_loss);
  image.push_back(r.image), drifting.push_back(r.drifting);
  ++owned;
}

std::vector<ParticleRecord> ParticleStore::records() const {
  std::vector<ParticleRecord> out;
  out.reserve(static_cast<std::size_t>(owned));
  for (Index i = 0; i < owned; ++i) out.push_back(record(i));
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.global_id < b.global_id; });
  return out;
}

namespace {

template <class T>
void permute(std::vector<T>& values, const std::vector<Index>& from) {
  std::vector<T> sorted(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) sorted[i] = values[static_cast<std::size_t>(from[i])];
  values.swap(sorted);
}

}  // namespace

void ParticleStore::reorder(const std::vector<Index>& from) {
  permute(position, from), permute(velocity, from), permute(material, from), permute(global_id, from);
  permute(acceleration, from), permute(force, from), permute(image, from), permute(drifting, from);
  permute(contact_loss, from), permute(loss_power, from), permute(integrator_loss, from);
  owned = static_cast<Index>(from.size());
}

std::vector<ParticleRecord> initial_records(const ParticleSet& set, const Subdomain& subdomain) {
  std::vector<ParticleRecord> records(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    ParticleRecord& r = records[i];
    r.global_id = set.first_id + static_cast<GlobalId>(i);
    r.position = subdomain.wrap(snap(set.position[i], subdomain.snap_constant()), r.image);
    r.image = {};
    r.velocity = set.velocity[i];
  }
  return records;
}

}  // namespace scree
