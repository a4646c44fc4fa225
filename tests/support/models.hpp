// Models from decks for tests.
#pragma once

#include <string>
#include <vector>

#include "model/builder/build.hpp"
#include "support/decks.hpp"

namespace scree {

inline Model model_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Log log(true);
  return build_model(parse_deck(text, "deck.toml", overrides), log);
}

// The warnings of a deck that builds.
inline std::vector<std::string> model_warnings(const std::string& text,
                                               const std::vector<std::string>& overrides = {}) {
  Log log(true);
  build_model(parse_deck(text, "deck.toml", overrides), log);
  return log.warnings();
}

inline std::string model_error(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return input_error([&] { model_of(text, overrides); });
}

}  // namespace scree
