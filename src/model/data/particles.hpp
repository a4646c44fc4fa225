// Initial state of the particles.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/choices.hpp"
#include "model/data/share.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

// Totals over the particles of all ranks, those that inserters may add until the end of the run included;
// lengths and masses are 0 where there are none.
struct ParticleTotals {
  struct OfMaterial {
    std::int64_t count = 0;
    Real smallest_radius = 0, smallest_mass = 0;  // [m], [kg]
    Real smallest_inertia_factor = 0;             // I / (m R^2)
  };
  std::int64_t at_start = 0;                       // particles at t = 0
  std::int64_t count = 0;                          // the most particles that can exist
  Real smallest_radius = 0, largest_radius = 0;    // [m]
  Real smallest_mass = 0, largest_mass = 0;        // [kg]
  Real smallest_density = 0, largest_density = 0;  // of spheres with these radii and masses [kg/m^3]
  Real most_radii_per_second = 0;                  // speed over the particle's own radius [1/s]
  Vec3 lowest, highest;                            // corners of the box around all centres at t = 0 [m]
  std::vector<OfMaterial> materials;               // as many as Contact::material_names
};

// Mean mass of the particles of a group with different sizes, by number, as it follows from their
// distribution [kg].
struct MeanMass {
  CountedBy by = CountedBy::number;  // what the distribution of the deck counts
  Real mass = 0;
  Real of_other_reading = 0;  // if it counted the other
};

// A group of the deck, whose ids extend to the first id of the next group, or an inserter.
struct ParticleGroup {
  std::string name;       // its number where the deck gives no name
  GlobalId first_id = 0;  // of its first particle
  std::optional<MeanMass> mean_mass{};
};

// Structure of arrays with one entry per particle of this rank: global ids from first_id on. The global id is
// the particle's index in the deck's order, from 0.
struct ParticleSet {
  std::vector<Vec3> position;          // [m]
  std::vector<Vec3> velocity;          // [m/s]
  std::vector<Vec3> angular_velocity;  // [rad/s]; empty: zero
  std::vector<Real> radius;            // [m]
  std::vector<Real> mass;              // [kg]
  std::vector<Real> inertia_factor;    // I / (m R^2); empty: solid spheres or discs
  std::vector<int> material;           // index into Contact::material_names
  int dimension = 3;                   // 2: discs
  GlobalId first_id = 0;
  ParticleTotals totals;
  std::vector<ParticleGroup> groups;  // of all ranks' particles, in the deck's order, then the inserters
  int inserters = 0;                  // number of inserters

  std::size_t size() const { return position.size(); }
  Real inertia_factor_of(std::size_t i) const {
    return inertia_factor.empty() ? solid_inertia_factor(dimension) : inertia_factor[i];
  }
  // Id of the n-th particle of an inserter, n from 0: the inserters' ids alternate, so that an id depends
  // neither on the births of other inserters nor on the particles that have been removed.
  GlobalId id_of_birth(int inserter, std::int64_t n) const {
    return totals.at_start + n * inserters + inserter;
  }
  IdRange ids() const { return {first_id, first_id + static_cast<GlobalId>(size())}; }
};

// Number of the group of each particle. ids: in ascending order.
std::vector<int> groups_of(const ParticleSet& particles, std::span<const GlobalId> ids);

// The particles of one material that an inserter adds.
struct BornParticles {
  std::int64_t count = 0;                          // until the end of the run
  Real smallest_radius = 0, largest_radius = 0;    // [m]
  Real smallest_mass = 0, largest_mass = 0;        // [kg]
  Real smallest_density = 0, largest_density = 0;  // as in ParticleTotals [kg/m^3]
  Real smallest_inertia_factor = 0;                // I / (m R^2)
  Real most_speed = 0;                             // at birth [m/s]
  Vec3 lowest, highest;                            // corners of the box around the births [m]
  int material = 0;
};
// Widens the ranges of the totals by these particles, and adds them to those of their material.
void add_births(ParticleTotals& totals, const BornParticles& born);

// Recomputes the totals after particles were changed. materials: their number. Collective.
void count_particles(ParticleSet& particles, int materials, const Share& share = Share());

}  // namespace scree
