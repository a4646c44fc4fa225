// Differences between two decks, key by key.
#pragma once

#include <string>
#include <vector>

namespace scree {

struct DeckDifference {
  std::string key;            // as --set takes it: "contact.pairs.0.damping"
  std::string pattern;        // equal for all elements of a list: "contact.pairs.*.damping"
  std::string before, after;  // as TOML, shortened; "nothing" where the deck has no such key
};

// Differences between two fingerprints (Deck::fingerprint), in the order of their keys. `before` may have
// names of earlier versions. A list whose elements differ, by name or number, is one difference, in addition
// to those of the elements that both have. A text that is not TOML is one difference with an empty key.
std::vector<DeckDifference> deck_differences(const std::string& before, const std::string& after);

// "time.step: 0.001 -> 0.0005"
std::string to_text(const DeckDifference& difference);

}  // namespace scree
