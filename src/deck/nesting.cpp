#include "deck/nesting.hpp"

#include <algorithm>

namespace scree {

namespace {

// Length of the string at the beginning of a text, quotes included; an unterminated string extends to the end
// of its line, or of the text.
std::size_t string_length(std::string_view text) {
  const char quote = text.front();
  const bool basic = quote == '"';
  const std::string_view three = basic ? "\"\"\"" : "'''";
  const bool several_lines = text.starts_with(three);
  const std::size_t quotes = several_lines ? 3 : 1;
  for (std::size_t i = quotes; i < text.size(); ++i) {
    if (basic && text[i] == '\\') {
      ++i;
    } else if (!several_lines && text[i] == '\n') {
      return i;
    } else if (several_lines ? text.substr(i).starts_with(three) : text[i] == quote) {
      return i + quotes;
    }
  }
  return text.size();
}

bool belongs_to_key(char c) {
  const bool bare = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return bare || c == '_' || c == '-' || c == ' ' || c == '\t';
}

}  // namespace

int line_of_deep_key(std::string_view toml) {
  int line = 1, dots = 0;
  for (std::size_t i = 0; i < toml.size();) {
    const char c = toml[i];
    std::size_t length = 1;
    if (c == '"' || c == '\'') {
      length = string_length(toml.substr(i));
    } else if (c == '#') {
      length = std::min(toml.find('\n', i), toml.size()) - i;
    } else if (c == '.') {
      if (++dots >= kMostKeyParts) return line;
    } else if (!belongs_to_key(c)) {
      dots = 0;
    }
    const std::string_view passed = toml.substr(i, length);
    line += static_cast<int>(std::count(passed.begin(), passed.end(), '\n'));
    i += length;
  }
  return 0;
}

}  // namespace scree
