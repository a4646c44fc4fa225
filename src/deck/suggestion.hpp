// "Did you mean": the known name nearest to a misspelt one, or the key or word for a synonym.
#pragma once

#include <string>
#include <vector>

namespace scree {

// "; did you mean \"step\"?" where a name differs from a known one by a letter or a quarter of its letters,
// or in case; otherwise "; known: a, b, c" ("" without names).
std::string suggestion(const std::string& misspelt, const std::vector<std::string>& names);
// suggestion() for an unknown key of a table with these keys. Also recognises synonyms (deck/synonyms.hpp),
// those of keys in other tables by their paths: "; did you mean \"time.step\"?".
std::string key_suggestion(const std::string& misspelt, const std::vector<std::string>& names);
// Suggests a word of a choice for an unknown word: by synonym or similar spelling; "" where there is none.
std::string word_suggestion(const std::string& misspelt, const std::vector<std::string>& words);

}  // namespace scree
