// Bodies of meshes that nothing stops: what they pass through.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// One text for each finding, empty ones among them: nothing in the deck touches the meshes; bodies that no
// joint holds pass through walls that are meshes, or through planes for which no pair has a law.
std::vector<std::string> loose_meshes(const DeckTable& deck, const Model& model);

}  // namespace scree
