// Mass of a particle from its density.
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

}  // namespace scree
