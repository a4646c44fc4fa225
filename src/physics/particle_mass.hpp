// Mass of a particle from its density, and moment of inertia from its mass.
#pragma once

#include <numbers>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// [kg]; radius [m], density [kg/m^3].
SCREE_HD Real sphere_mass(Real radius, Real density) {
  return density * Real(4) / 3 * std::numbers::pi_v<Real> * radius * radius * radius;
}

// [kg]; radius and thickness [m], density [kg/m^3].
SCREE_HD Real disc_mass(Real radius, Real thickness, Real density) {
  return density * thickness * std::numbers::pi_v<Real> * radius * radius;
}

// About the centre [kg m^2]; mass [kg], radius [m].
SCREE_HD Real sphere_inertia(Real mass, Real radius) { return Real(0.4) * mass * radius * radius; }
SCREE_HD Real disc_inertia(Real mass, Real radius) { return Real(0.5) * mass * radius * radius; }

}  // namespace scree
