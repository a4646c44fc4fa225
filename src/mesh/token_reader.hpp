// Tokens of a text file in order, with the position for messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/types.hpp"

namespace scree {

// Tokens are separated by blanks. A backslash at the end of a line continues it, except in skip_line(), as
// comments may end with one.
class TokenReader {
 public:
  // file: its name in messages. text must outlive this object.
  TokenReader(std::string_view text, std::string file);

  // The next token; empty at the end of the file.
  std::string_view next();
  // The next token of the line; empty at the end of the line.
  std::string_view next_in_line();
  // Skips to the next line and returns the rest of the present one.
  std::string_view skip_line();
  void skip_blank_lines() { skip_blanks(true); }
  std::size_t position() const { return at_; }

  // The line's next token as a number. Throws InputError, as fail() does, where it is not a finite number;
  // what: e.g. "coordinate".
  Real number(const char* what);
  // The token as a whole number with sign, of 64 bits.
  std::int64_t to_integer(std::string_view word, const char* what) const;
  // Throws InputError with "file:line: trouble", of the line of the last token.
  [[noreturn]] void fail(const std::string& trouble) const;

 private:
  void skip_blanks(bool over_lines);
  std::string_view take_token();

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1, token_line_ = 1;
};

// A token of any length, abbreviated for a message.
std::string quoted(std::string_view word);
// The token in lower case.
std::string lower(std::string_view word);

}  // namespace scree
