// Start state of the particles.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Structure of arrays, one entry per particle. The global id is the deck's order, counted from 0.
struct ParticleSet {
  std::vector<Vec3> position;  // [m]
  std::vector<Vec3> velocity;  // [m/s]
  std::vector<Real> radius;    // [m]
  std::vector<Real> mass;      // [kg]
  std::vector<int> material;   // index into Contact::material_names

  std::size_t size() const { return position.size(); }
};

}  // namespace scree
