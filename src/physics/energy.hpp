// Energies and angular momentum of a particle.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"

namespace scree {

// Kinetic energy [J]; mass [kg], velocity [m/s].
SCREE_HD Real kinetic_energy(Real mass, Vec3 velocity) { return mass / 2 * dot(velocity, velocity); }

// Rotational energy [J]; moment of inertia [kg m^2], spin [rad/s].
SCREE_HD Real rotational_energy(Real inertia, Vec3 spin) { return inertia / 2 * dot(spin, spin); }

// Angular momentum about the origin [kg m^2/s].
SCREE_HD Vec3 angular_momentum(Real mass, Vec3 position, Vec3 velocity, Real inertia, Vec3 spin) {
  return mass * cross(position, velocity) + inertia * spin;
}

// Potential energy [J], zero at the origin; gravity [m/s^2].
SCREE_HD Real gravitational_energy(Real mass, Vec3 gravity, Vec3 position) {
  return -mass * dot(gravity, position);
}

}  // namespace scree
