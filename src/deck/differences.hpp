// Where two decks differ, key by key.
#pragma once

#include <string>
#include <vector>

namespace scree {

struct DeckDifference {
  std::string key;            // as --set takes it: "contact.pairs.0.damping"
  std::string pattern;        // the same for all entries of a list: "contact.pairs.*.damping"
  std::string before, after;  // as TOML, shortened; "nothing" where the deck has no such key
};

// Of two fingerprints (Deck::fingerprint), in the order of their keys. A list whose entries are not the same
// ones, by name or else by number, differs as a whole, and so may those that both have. A text that is no
// TOML differs as a whole, with an empty key.
std::vector<DeckDifference> deck_differences(const std::string& before, const std::string& after);

// "time.step: 0.001 -> 0.0005"
std::string to_text(const DeckDifference& difference);

}  // namespace scree
