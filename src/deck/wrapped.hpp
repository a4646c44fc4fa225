// Text broken into lines.
#pragma once

#include <string>

namespace scree {

// Breaks a text into lines of at most `width` characters, each indented and ended by \n. A longer word is on
// a line of its own.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent = 0);

}  // namespace scree
