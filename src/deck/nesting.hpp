// Keys nested too deep, found before TOML's parser meets them: it calls itself for every part of a key.
#pragma once

#include <string_view>

namespace scree {

constexpr int kMostKeyParts = 16;  // a deck needs four

// Line, counted from 1, of the first dotted key or table header in a TOML text that has more parts than
// kMostKeyParts; 0 where there is none.
int line_of_deep_key(std::string_view toml);

}  // namespace scree
