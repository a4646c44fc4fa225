// Warnings for models that can be computed but are unlikely to be intended.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/checks/impact_speed.hpp"
#include "model/checks/limits.hpp"
#include "model/data/model.hpp"

namespace scree {

// Findings about the whole model, one text each. Does not visit the particles.
std::vector<std::string> implausible(const DeckTable& deck, const Model& model);

// Weight on a particle at the bottom of the bed that all particles form on the base of the domain [N]; 0
// without gravity.
Real weight_at_bottom(const Model& model);

// Throws InputError for contacts whose duration or step limit is 0 or infinite.
void check_step_limits(const DeckTable& deck, const Model& model);
// Throws InputError for a positive value below the normal numbers: products with it lose digits.
void check_normal(const DeckTable& table, const std::string& key, Real value);

}  // namespace scree
