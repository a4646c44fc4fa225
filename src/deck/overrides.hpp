// Inserts values from the command line (--set) into the deck's TOML tree before it is checked.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace scree {

// override_text: "key.path=value". Elements of lists of tables are addressed by name or number; missing
// tables are created. Throws InputError.
void apply_override(toml::table& deck, const std::string& override_text);

}  // namespace scree
