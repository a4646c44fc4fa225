// From the deck to the model.
#pragma once

#include <vector>

#include "base/log.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Builds and checks the whole model. Warnings (overlaps at the start, steps far above a contact time,
// files without particles) go to the log. Throws InputError on anything that contradicts itself, naming
// place, key, value and what is allowed; IoError on files of particles that cannot be read. Collective where
// there are several ranks: each has its part of the particles, and all else of the model, warnings and errors
// are the same on all.
Model build_model(const Deck& deck, Log& log, const Share& share = Share());
// The same; `chosen` gets the values that the deck leaves to the program, with their reasons.
Model build_model(const Deck& deck, Log& log, const Share& share, std::vector<ChosenValue>& chosen);

}  // namespace scree
