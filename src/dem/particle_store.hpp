// Particles of one rank: structure of arrays in cell order.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// What a checkpoint stores of one particle besides its constant properties.
struct ParticleRecord {
  GlobalId global_id = 0;
  Vec3 position;             // inside the periodic box [m]
  Vec3 velocity;             // [m/s]
  Vec3 acceleration;         // HHT's or Verlet's a_n [m/s^2]
  Vec3 force;                // total force at t_n [N]
  Real contact_loss = 0;     // dissipated in this particle's share of its contacts since t = 0 [J]
  Real loss_power = 0;       // the same at t_n [W]
  Real integrator_loss = 0;  // taken out by HHT since t = 0 [J]
  ImageCount image;
  bool drifting = false;  // has left through an open side
};

// A particle that changes its rank, complete.
struct Migrant {
  ParticleRecord state;
  Real radius = 0;  // [m]
  Real mass = 0;    // [kg]
  std::int64_t material = 0;
};

// Items: owned particles [0, owned), ghosts [owned, owned + ghosts), shapes of bodies after them. Owned
// particles in the pair search come first; those that drift outside stand at the end of the owned. `position`
// and `velocity` hold all items; the other arrays the owned particles.
struct ParticleStore {
  std::vector<Vec4> position;       // x, y, z, radius [m]
  std::vector<Vec4> velocity;       // x, y, z [m/s], mass [kg]
  std::vector<int> material;        // all items
  std::vector<GlobalId> global_id;  // all items; shapes count on after the particles
  std::vector<Vec3> acceleration;   // [m/s^2]
  std::vector<Vec3> force;          // gravity and contacts [N]
  std::vector<Real> contact_loss, loss_power, integrator_loss;  // see ParticleRecord
  std::vector<ImageCount> image;
  std::vector<std::uint8_t> drifting;
  Index owned = 0;
  Index active = 0;  // owned particles in the pair search

  // records: of particles that are in the set.
  void load(const ParticleSet& set, std::span<const ParticleRecord> records);
  std::vector<ParticleRecord> records() const;  // ordered by global id
  ParticleRecord record(Index i) const;
  Migrant migrant(Index i) const;
  void add(const Migrant& particle);  // behind the owned; the store holds owned particles alone then
  // Puts the owned particles into the order of `from`: new i was old from[i].
  void reorder(const std::vector<Index>& from);
};

// Start of the simulation: positions and velocities of the model, the rest zero.
std::vector<ParticleRecord> initial_records(const ParticleSet& set, const Subdomain& subdomain);

}  // namespace scree
