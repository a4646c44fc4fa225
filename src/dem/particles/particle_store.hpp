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
// particles in the pair search come first; those that drift outside stand at the end of the owned. Which
// arrays hold all items and which the owned particles, their kinds say.
struct ParticleStore : FieldArrays<HostArray>, FieldsThere {
  Index owned = 0;
  Index active = 0;  // owned particles in the pair search

  void load(std::span<const Particle> records);
  std::vector<Particle> records() const;  // of the owned particles, ordered by global id
  void add(const Particle& particle);     // behind the owned; the store holds owned particles alone then
  // Puts the owned particles into the order of `from`: new i was old from[i].
  void reorder(const std::vector<Index>& from);
  // Makes room for so many items, in the arrays of all items.
  void resize_items(Index items);
};

// The number of one rank's particles. Throws InputError where it is no Index. of_all: counted.
Index count_on_rank(std::size_t particles, const ParticleTotals& of_all);

// Start of the simulation: positions, velocities and constants of the model, the rest zero.
std::vector<Particle> initial_records(const ParticleSet& set, const Subdomain& subdomain);
// Gives particles that are in the set the constants that they have there.
void take_constants(const ParticleSet& set, std::span<Particle> records);

}  // namespace scree
