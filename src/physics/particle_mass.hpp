// Mass of a particle from its density, and moment of inertia from its mass.
#pragma once

#include <numbers>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// Mass of a sphere [kg]; radius [m], density [kg/m^3].
SCREE_HD Real sphere_mass(Real radius, Real density) {
  return density * Real(4) / 3 * std::numbers::pi_v<Real> * radius * radius * radius;
}

// Mass of a disc [kg]; radius and thickness [m], density [kg/m^3].
SCREE_HD Real disc_mass(Real radius, Real thickness, Real density) {
  return density * thickness * std::numbers::pi_v<Real> * radius * radius;
}

// Volume of a sphere [m^3], in 2D the area of a disc [m^2]; radius [m].
SCREE_HD Real solid_size(Real radius, int dimension) {
  return dimension == 2 ? disc_mass(radius, 1, 1) : sphere_mass(radius, 1);
}

// Moment of inertia about the centre over m R^2, of a solid sphere (2D: disc). A hollow sphere has 2/3, a
// ring 1.
SCREE_HD Real solid_inertia_factor(int dimension) { return dimension == 2 ? Real(0.5) : Real(0.4); }
// Moment of inertia [kg m^2]; mass [kg], radius [m].
SCREE_HD Real moment_of_inertia(Real factor, Real mass, Real radius) {
  return factor * mass * radius * radius;
}

}  // namespace scree
