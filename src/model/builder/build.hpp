// Builds the model from the deck.
#pragma once

#include <vector>

#include "base/log.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Builds and checks the whole model. Warnings (overlaps at the start, steps far above a contact time, files
// without particles) go to the log. Throws InputError on contradictions, with place, key, value and the
// allowed values, and IoError on particle files that cannot be read. Collective where there are several
// ranks: each rank has its part of the particles; everything else, with warnings and errors, is equal on all
// ranks.
Model build_model(const Deck& deck, Log& log, const Share& share = Share());
// build_model() that also returns, in `chosen`, the values that the deck leaves to the program, with their
// reasons.
Model build_model(const Deck& deck, Log& log, const Share& share, std::vector<ChosenValue>& chosen);

}  // namespace scree
