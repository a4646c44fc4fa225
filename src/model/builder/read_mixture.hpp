// Mixtures of particles, read from the deck.
#pragma once

#include "deck/deck.hpp"
#include "model/data/names.hpp"
#include "model/derived/mixture.hpp"

namespace scree {

// The mixture of a table with the keys of mixture_list_keys() and an integer "seed": its list "mixture", or
// particles of one kind that the table itself gives. Throws InputError where both or none are given, or where
// a component is incomplete.
Mixture read_mixture(const DeckTable& table, const ModelNames& names, int dimension);

}  // namespace scree
