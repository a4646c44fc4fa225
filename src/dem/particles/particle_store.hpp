// Particles of one rank: structure of arrays in cell order.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "dem/particles/particle_fields.hpp"
#include "model/data/model.hpp"
#include "partition/subdomain.hpp"

namespace scree {

template <class T>
using HostArray = std::vector<T>;

inline FieldsThere fields_there(const Model& model) { return {model.rotates(), model.rolls()}; }

// Items: owned particles [0, owned), ghosts [owned, owned + ghosts), shapes of bodies after them. Owned
// particles in the search come first, escaped ones last. FieldArrayKind says which arrays cover all items and
// which the owned particles only.
struct ParticleStore : FieldArrays<HostArray>, FieldsThere {
  Index owned = 0;
  Index active = 0;  // owned particles in the search

  void load(std::span<const Particle> records);
  std::vector<Particle> records() const;  // of the owned particles, ordered by global id
  void add(const Particle& particle);     // after the owned particles, without ghosts in the store
  // Reorders the owned particles: new i was old from[i].
  void reorder(const std::vector<Index>& from);
  // Resizes the arrays of all items.
  void resize_items(Index items);
};

// Number of particles of one rank. Throws InputError where it exceeds Index. of_all: counted totals.
Index count_on_rank(std::size_t particles, const ParticleTotals& of_all);

// Initial state: positions, velocities and constants of the model; all other fields are zero.
std::vector<Particle> initial_records(const ParticleSet& set, const Subdomain& subdomain);
// Sets the constants of particles from the set; those that are not in it, born during a run, keep theirs.
void take_constants(const ParticleSet& set, std::span<Particle> records);

}  // namespace scree
