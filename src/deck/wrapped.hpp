// Text in lines of a width.
#pragma once

#include <string>

namespace scree {

// The words of a text in lines of at most `width` characters, each line indented and ended by \n. A word that
// is longer has a line of its own.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent = 0);

}  // namespace scree
