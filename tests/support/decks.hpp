// Small decks for tests, and the messages of wrong ones.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "deck/deck.hpp"

namespace scree {

// The tables that every deck needs; tests add to it.
inline const std::string kSmallDeck = R"(
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 1.0
step = 1e-3
control = "fixed"
)";

// Runs `action` and returns the text of its InputError; "" where it throws none.
template <class Action>
std::string input_error(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline std::string deck_error(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return input_error([&] { parse_deck(text, "deck.toml", overrides); });
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace scree
