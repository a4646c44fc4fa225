// `scree keys WORD`: the keys of a deck that a word is about.
#pragma once

#include <string>

namespace scree {

// Keys whose path, meaning or words have `word` in them, and those that a synonym of it means, as lines for a
// terminal; first what the deck does not have, where the word is of such a thing. Throws InputError where
// there is nothing, with names that are spelled alike and the page of limits.
std::string keys_about(const std::string& word);

}  // namespace scree
