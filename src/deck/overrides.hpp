// Values from the command line (--set) put into the deck's TOML tree before it is checked.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace scree {

// override_text: "key.path=value". Elements of lists of tables go by name or number; tables that are not
// there yet are made. Throws InputError.
void apply_override(toml::table& deck, const std::string& override_text);

}  // namespace scree
