// Keys nested too deep, found before parsing: TOML's parser is recursive in the parts of a key.
#pragma once

#include <string_view>

namespace scree {

constexpr int kMostKeyParts = 16;  // a deck needs four

// Line, counted from 1, of the first dotted key or table header with more than kMostKeyParts parts in a TOML
// text; 0 where there is none.
int line_of_deep_key(std::string_view toml);

}  // namespace scree
