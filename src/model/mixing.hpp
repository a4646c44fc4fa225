// Pairs of materials that the deck does not give, made of the pairs of each material with itself.
#pragma once

#include <string>

#include "deck/choices.hpp"
#include "deck/deck.hpp"

namespace scree {

// The mean of two values that the rule names, or the smaller or larger one; symmetric, and a where both are
// alike. rule: not none.
Real mixed(Mixing rule, Real a, Real b);
// K of two springs F = K d^n in series, each of which is half of a like pair's: at one force the overlap is
// the mean of the overlaps of the like pairs, K^(-1/n) = (K_a^(-1/n) + K_b^(-1/n)) / 2 [N/m^n]. Both above 0,
// or both 0.
Real in_series(Real a, Real b, Real exponent = 1);

// The keys of the pair of the materials name_a and name_b, from those of a with a and of b with b: what
// [[contact.pairs]] would say. contact: the deck's table, with a rule. Throws InputError where a like pair is
// missing, or where the two cannot be combined.
DeckTable combined_pair(const DeckTable& contact, const std::string& name_a, const std::string& name_b);
// The numbers and words of a combined pair, without its materials and what its standard value says:
// "stiffness = 1e5, friction = 0.3".
std::string keys_of(const DeckTable& pair);

}  // namespace scree
