// Warnings of models that can be computed but can hardly be meant.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/checks/impact_speed.hpp"
#include "model/checks/limits.hpp"
#include "model/data/model.hpp"

namespace scree {

// What seems wrong with the whole model, one text for each finding. Costs no pass over the particles.
std::vector<std::string> implausible(const DeckTable& deck, const Model& model);

// Weight of the particles above one at the bottom, which all lie on the base of the space [N]; 0 without
// gravity.
Real weight_at_bottom(const Model& model);

// Refuses contacts whose duration or step limit is 0 or infinite. Throws InputError.
void check_step_limits(const DeckTable& deck, const Model& model);
// Refuses a positive value that is smaller than any normal number: products with it lose their digits.
void check_normal(const DeckTable& table, const std::string& key, Real value);

}  // namespace scree
