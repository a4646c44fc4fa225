// The normal law of a pair of materials from its keys in [[contact.pairs]].
#pragma once

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Whether a key is given with a value above 0: for these keys 0 is equal to leaving the key out.
inline bool is_positive(const DeckTable& table, const char* key) {
  return table.has(key) && table.real(key) > 0;
}

// Throws InputError where a material has one of young_modulus and poisson_ratio alone.
void check_moduli(const DeckTable& material);
// The law without attraction. table: of the pair; material: indices of its materials. The masses and radii of
// the model's particles and surfaces determine the stiffness for a largest overlap. Throws InputError for
// keys that do not fit together.
NormalLawParameters build_law(const DeckTable& deck, const DeckTable& table, const Model& model,
                              const int (&material)[2]);
// Adds adhesion and attraction to the law. Throws InputError where the law cannot have them.
void take_attraction(const DeckTable& table, NormalLawParameters& law);
// Adds liquid bridges to the law, before its attraction. dimension: of the domain.
void take_bridges(const DeckTable& table, int dimension, NormalLawParameters& law);

}  // namespace scree
