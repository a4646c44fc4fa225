// Makes text from outside (decks, files, command lines) suitable for messages.
#pragma once

#include <string>
#include <string_view>

namespace scree {

// Escapes control characters, bytes that are not UTF-8, and marks that change the writing direction: \n,
// \x1b.
std::string printable(std::string_view text);
// Removes the middle of a text longer than `most` bytes, for one line of a log.
std::string shortened(const std::string& text, std::size_t most);

}  // namespace scree
