// Energies of a point mass.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"

namespace scree {

// [J]; mass [kg], velocity [m/s].
SCREE_HD Real kinetic_energy(Real mass, Vec3 velocity) { return mass / 2 * dot(velocity, velocity); }

// [J], zero at the origin; gravity [m/s^2].
SCREE_HD Real gravitational_energy(Real mass, Vec3 gravity, Vec3 position) {
  return -mass * dot(gravity, position);
}

}  // namespace scree
