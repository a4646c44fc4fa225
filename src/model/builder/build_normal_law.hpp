// The normal law of a pair of materials from its keys in [[contact.pairs]].
#pragma once

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Throws InputError where a material has one of young_modulus and poisson_ratio alone.
void check_moduli(const DeckTable& material);
// Stiffness, exponent and damping of the law; deck/pair_laws.hpp adds the rest. table: of the pair; material:
// indices of its materials. The masses and radii of the model's particles and surfaces determine the
// stiffness for a largest overlap. Throws InputError for keys that do not fit together.
NormalLawParameters build_law(const DeckTable& deck, const DeckTable& table, const Model& model,
                              const int (&material)[2]);

}  // namespace scree
