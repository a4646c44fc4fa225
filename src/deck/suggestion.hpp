// "Did you mean": the known name nearest to a misspelt one.
#pragma once

#include <string>
#include <vector>

namespace scree {

// "; did you mean \"step\"?" where a name differs by a letter or a quarter of them, or in capitals, otherwise
// "; known: a, b, c" ("" without names).
std::string suggestion(const std::string& misspelt, const std::vector<std::string>& names);

}  // namespace scree
