// Text of others (decks, files, command lines) made fit for messages.
#pragma once

#include <string>
#include <string_view>

namespace scree {

// With \n, \x1b and the like in place of control characters, of bytes that are not UTF-8, and of the marks
// that turn the direction of writing.
std::string printable(std::string_view text);
// Without the middle where it is longer than most bytes, for one line of a log.
std::string shortened(const std::string& text, std::size_t most);

}  // namespace scree
