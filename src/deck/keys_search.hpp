// `scree keys WORD`: finds keys of the deck by a word.
#pragma once

#include <string>

namespace scree {

// Lists, for a terminal, the keys whose path, text, words or former names contain `word`, and those of which
// it is a synonym. Where the word names something that decks do not support, a line says so first. Throws
// InputError where nothing is found, with similarly spelled names and the page of limits.
std::string keys_about(const std::string& word);

}  // namespace scree
