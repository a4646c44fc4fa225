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

// Totals over the particles of all ranks; lengths and masses are 0 where there are none.
struct ParticleTotals {
  struct OfMaterial {
    std::int64_t count = 0;
    Real smallest_radius = 0, smallest_mass = 0;  // [m], [kg]
    Real smallest_inertia_factor = 0;             // I / (m R^2)
  };
  std::int64_t count = 0;
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

// A group of the deck; its ids extend to the first id of the next group.
struct ParticleGroup {
  std::string name;       // its number where the deck gives no name
  GlobalId first_id = 0;  // of its first particle
  std::optional<MeanMass> mean_mass{};
};
// Number of the group of each particle. ids: in ascending order.
std::vector<int> groups_of(const std::vector<ParticleGroup>& groups, std::span<const GlobalId> ids);

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
  std::vector<ParticleGroup> groups;  // of all ranks' particles, in the deck's order

  std::size_t size() const { return position.size(); }
  Real inertia_factor_of(std::size_t i) const {
    return inertia_factor.empty() ? solid_inertia_factor(dimension) : inertia_factor[i];
  }
  IdRange ids() const { return {first_id, first_id + static_cast<GlobalId>(size())}; }
};

// Recomputes the totals after particles were changed. materials: their number. Collective.
void count_particles(ParticleSet& particles, int materials, const Share& share = Share());

}  // namespace scree
