// Pairs of materials that the deck does not give, made of the pairs of each material with itself.
#pragma once

#include <map>
#include <string>

#include "deck/choices.hpp"
#include "deck/deck.hpp"

namespace scree {

// The mean of two values that the rule names, or the smaller or larger one; symmetric, and a where both are
// alike. rule: not none.
Real mixed(Mixing rule, Real a, Real b);

// The pairs of [[contact.pairs]] of a material with itself, by its name.
using LikePairs = std::map<std::string, const DeckTable*>;
LikePairs like_pairs(const DeckTable& contact);

// The keys of the pair of the materials name_a and name_b, from those of a with a and of b with b: what
// [[contact.pairs]] would say. contact: the deck's table, with a rule. Throws InputError where a like pair is
// missing, or where the two cannot be combined.
DeckTable combined_pair(const DeckTable& contact, const LikePairs& like, const std::string& name_a,
                        const std::string& name_b);
// The numbers and words of a combined pair, without its materials and what its standard value says:
// "stiffness = 1e5, friction = 0.3".
std::string keys_of(const DeckTable& pair);

}  // namespace scree
