// Converts TOML nodes to checked values, according to the keys' declarations.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "deck/deck.hpp"

namespace scree {

// text: of the deck from which `source` was parsed, without overrides; path: of the deck; both for messages.
// Throws InputError.
DeckTable read_deck(const toml::table& source, const std::string& text, const std::string& path);

// "bodies.lid", "mass" -> "bodies.lid.mass"; the name alone at the top of the deck.
std::string join_path(const std::string& table, const std::string& key);

// Place of a node: "deck.toml:12:8", or "--set key=value" for a node of an override, or `otherwise` for a
// node without a source.
std::string location_of(const toml::source_region& source, const std::string& otherwise);

}  // namespace scree
