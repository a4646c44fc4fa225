// From TOML nodes to checked values, driven by the keys' declarations.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "deck/deck.hpp"

namespace scree {

// text: what `source` was parsed from, but for overrides; path: of the deck; both for messages. Throws
// InputError.
DeckTable read_deck(const toml::table& source, const std::string& text, const std::string& path);

// Position of a node: "deck.toml:12:8", or "--set key=value" where an override brought it, or `otherwise` for
// a node that no text stands for.
std::string place_of(const toml::source_region& source, const std::string& otherwise);

}  // namespace scree
