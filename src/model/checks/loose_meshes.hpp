// Finds meshes of bodies that pass through other objects without contact.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// One text for each finding, some of them empty: nothing in the deck touches the meshes; bodies without a
// joint pass through walls that are meshes, or through planes for which no pair has a law.
std::vector<std::string> loose_meshes(const DeckTable& deck, const Model& model);

}  // namespace scree
