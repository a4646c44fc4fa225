// Pairs of materials that the deck does not give, combined from the pairs of each material with itself.
#pragma once

#include <map>
#include <string>

#include "deck/choices.hpp"
#include "deck/deck.hpp"

namespace scree {

// The mean of two values by this rule, or the smaller or larger value; symmetric, and exactly a where both
// are equal. rule: not none.
Real mixed(Mixing rule, Real a, Real b);

// The pairs of [[contact.pairs]] of a material with itself, by its name.
using LikePairs = std::map<std::string, const DeckTable*>;
LikePairs like_pairs(const DeckTable& contact);

// The pair of the materials name_a and name_b, with keys as in [[contact.pairs]], combined from the pairs of
// each with itself. contact: the deck's table, with a rule. Throws InputError where a pair is missing, or
// where the two cannot be combined.
DeckTable combined_pair(const DeckTable& contact, const LikePairs& like, const std::string& name_a,
                        const std::string& name_b);
// The values of a combined pair that differ from the defaults, without its materials: "stiffness = 1e5,
// friction = 0.3".
std::string keys_of(const DeckTable& pair);

}  // namespace scree
