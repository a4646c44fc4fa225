// The mean mass of the particles of a group.
#pragma once

#include <optional>

#include "deck/deck.hpp"
#include "model/data/particles.hpp"

namespace scree {

// Mean masses that follow from the distribution of radii or masses in the group's table; nothing where all
// are equal, or come from a file. material_density: [kg/m^3], 0 where not given.
std::optional<MeanMass> mean_mass(const DeckTable& group, Real material_density, int dimension);

}  // namespace scree
