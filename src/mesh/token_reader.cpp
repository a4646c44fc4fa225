#include "mesh/token_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "base/error.hpp"

namespace scree {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// from_chars() does not accept a plus sign.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

std::string quoted(std::string_view word) {
  constexpr std::size_t kMost = 40;
  const bool whole = word.size() <= kMost;
  return fmt::format("\"{}{}\"", word.substr(0, kMost), whole ? "" : "...");
}

std::string lower(std::string_view word) {
  std::string small(word);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

TokenReader::TokenReader(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // some text files begin with it
  if (text.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
}

void TokenReader::skip_blanks(bool over_lines) {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '\\') {
      const std::size_t end = text_.find_first_not_of('\r', at_ + 1);
      if (end == std::string_view::npos || text_[end] != '\n') return;
      at_ = end, ++line_;
    } else if (c == '\n' && over_lines) {
      ++line_;
    } else if (!is_blank(c)) {
      return;
    }
  }
}

std::string_view TokenReader::take_token() {
  const std::size_t first = at_;
  token_line_ = line_;
  while (at_ < text_.size() && text_[at_] != '\n' && !is_blank(text_[at_])) ++at_;
  return text_.substr(first, at_ - first);
}

std::string_view TokenReader::next() {
  skip_blanks(true);
  return take_token();
}

std::string_view TokenReader::next_in_line() {
  skip_blanks(false);
  return take_token();
}

std::string_view TokenReader::skip_line() {
  const std::size_t first = at_;
  at_ = std::min(text_.find('\n', at_), text_.size());
  return text_.substr(first, at_ - first);
}

Real TokenReader::number(const char* what) {
  const std::string_view word = next_in_line();
  if (word.empty()) fail(fmt::format("ends before a {}", what));
  const std::string_view digits = without_plus(word);
  Real value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument)
    fail(fmt::format("{} {}: must be a number", what, quoted(word)));
  // The number is too small or too large for a Real.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(digits).c_str(), nullptr);
  if (!std::isfinite(value)) fail(fmt::format("{} {}: must be a finite number", what, quoted(word)));
  return value;
}

std::int64_t TokenReader::to_integer(std::string_view word, const char* what) const {
  if (word.empty()) fail(fmt::format("ends before a {}", what));
  const std::string_view digits = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument)
    fail(fmt::format("{} {}: must be a whole number", what, quoted(word)));
  if (error != std::errc()) fail(fmt::format("{} {}: is too large", what, quoted(word)));
  return value;
}

void TokenReader::fail(const std::string& trouble) const {
  throw InputError(fmt::format("{}:{}: {}", file_, token_line_, trouble));
}

}  // namespace scree
