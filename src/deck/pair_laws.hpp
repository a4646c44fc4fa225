// Keys of [[contact.pairs]] by law: their declarations, and the parameters of the laws that follow from them.
// One file for each law of the list physics/contact_laws.def, deck/law_<name>.cpp.
#pragma once

#include <vector>

#include "deck/deck.hpp"
#include "physics/contact_parameters.hpp"

namespace scree {

// A pair of materials in the deck.
struct PairInDeck {
  const DeckTable& table;         // of the pair
  const DeckTable* materials[2];  // null where the deck has no materials
  int dimension;                  // of the domain
};

// Parameters of all laws of a pair of materials.
struct PairParameters {
  NormalLawParameters normal{};
  Friction friction{};
  RollingParameters rolling{};
  Real wear_coefficient = 0;  // [1/Pa]
};

struct PairLaw {
  std::vector<Key> (*keys)();
  // Adds the law's parameters to those of the laws before it in the list; the first finds the stiffness and
  // damping of the normal law. Throws InputError for keys that do not fit together.
  void (*take)(const PairInDeck& pair, PairParameters& parameters);
};

namespace pair_law_list {
#define SCREE_PAIR_LAW(name) PairLaw name();
#include "physics/contact_laws.def"
#undef SCREE_PAIR_LAW
}  // namespace pair_law_list

// In the order of the list, which is that of the manual.
const std::vector<PairLaw>& pair_laws();

// Whether a key is given with a value above 0: for these keys 0 is equal to leaving the key out.
inline bool is_positive(const DeckTable& table, const char* key) {
  return table.has(key) && table.real(key) > 0;
}

}  // namespace scree
