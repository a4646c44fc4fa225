// "Did you mean": the known name nearest to a misspelt one, or what others call so.
#pragma once

#include <string>
#include <vector>

namespace scree {

// "; did you mean \"step\"?" where a name differs by a letter or a quarter of them, or in capitals, otherwise
// "; known: a, b, c" ("" without names).
std::string suggestion(const std::string& misspelt, const std::vector<std::string>& names);
// The same for a key that a table of these names does not have: also a synonym (deck/synonyms.hpp), and where
// that is a key of another table, its path: "; did you mean \"time.step\"?".
std::string key_suggestion(const std::string& misspelt, const std::vector<std::string>& names);
// For what is none of a choice's words: a synonym or a near word, "" where none is.
std::string word_suggestion(const std::string& misspelt, const std::vector<std::string>& words);

}  // namespace scree
