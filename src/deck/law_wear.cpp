// Wear of a pair of materials.
#include "deck/pair_laws.hpp"

namespace scree {

namespace {

std::vector<Key> keys() {
  return {
      real("wear_coefficient", "1/Pa")
          .within(0, 1)
          .left_out("no wear")
          .combined(Combining::mean)
          .about("k/H of Archard's law (1953) for the field wear_depth: a mesh loses the volume k/H F s, F: "
                 "normal force, s: sliding distance, computed as the dissipation of friction over the "
                 "coefficient of friction. Shapes do not change. Needs friction above 0.")};
}

void take(const PairInDeck& pair, PairParameters& parameters) {
  if (!is_positive(pair.table, "wear_coefficient")) return;
  if (parameters.friction.friction == 0)
    pair.table.fail("wear_coefficient",
                    "needs friction above 0: the sliding distance is computed from its dissipation");
  parameters.wear_coefficient = pair.table.real("wear_coefficient");
}

}  // namespace

PairLaw pair_law_list::wear() { return {keys, take}; }

}  // namespace scree
