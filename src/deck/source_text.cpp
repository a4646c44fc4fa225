#include "deck/source_text.hpp"

#include <fmt/format.h>

namespace scree {

namespace {

// Bytes of the first `count` characters of UTF-8.
std::size_t bytes_of(std::string_view text, std::size_t count) {
  const auto goes_on = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80; };
  std::size_t bytes = 0;
  for (; bytes < text.size() && count > 0; --count) {
    ++bytes;
    while (bytes < text.size() && goes_on(bytes)) ++bytes;
  }
  return bytes;
}

}  // namespace

// A byte order mark is not a character of the first line.
SourceText::SourceText(std::string_view text, std::string_view path) : text_(text), path_(path) {
  lines_.push_back(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
  for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n', end + 1))
    lines_.push_back(end + 1);
}

std::string_view SourceText::at(const toml::source_region& region) const {
  constexpr std::size_t kFarthest = 10000;  // counting is linear in the column, for every value of a line
  const toml::source_position &begin = region.begin, &end = region.end;
  const bool here = region.path && *region.path == path_ && begin && end && begin.line == end.line &&
                    begin.line <= lines_.size() && begin.column < end.column && end.column < kFarthest;
  if (!here) return {};
  const std::string_view line = text_.substr(lines_[begin.line - 1]);
  const std::size_t first = bytes_of(line, begin.column - 1);
  return line.substr(first, bytes_of(line.substr(first), end.column - begin.column));
}

std::string number_text(Real x) {
  const std::string text = fmt::format("{}", x);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string shown(const toml::node& node, const SourceText& source) {
  constexpr std::size_t kLongest = 70;
  std::string text;
  if (const auto* array = node.as_array()) {
    for (const toml::node& entry : *array) {
      if (text.size() > kLongest) break;
      text += (text.empty() ? "" : ", ") + shown(entry, source);
    }
    text = "[" + text + "]";
  } else if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      if (text.size() > kLongest) break;
      text += (text.empty() ? " " : ", ") + std::string(key.str()) + " = " + shown(value, source);
    }
    text = "{" + text + " }";
  } else if (const auto* string = node.as_string()) {
    text = "\"" + string->get() + "\"";
  } else if (node.is_number()) {
    text = source.at(node.source());
    if (text.empty())
      text = node.is_integer() ? fmt::format("{}", node.as_integer()->get())
                               : number_text(node.as_floating_point()->get());
  } else {
    text = fmt::format("{}", node.value_or(false));
  }
  return text.size() > kLongest + 3 ? text.substr(0, kLongest) + "..." : text;
}

}  // namespace scree
