// The words of a text file, one after the other, with the place for messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/types.hpp"

namespace scree {

// Words stand between blanks. A backslash that ends a line makes the next one part of it, but in skip_line():
// comments end with what they like.
class Words {
 public:
  // file: its name in messages. text lives longer than this.
  Words(std::string_view text, std::string file);

  // Empty at the end of the file.
  std::string_view next();
  // Empty at the end of the line.
  std::string_view next_in_line();
  // The rest of the line.
  std::string_view skip_line();
  void skip_blank_lines() { skip_blanks(true); }
  std::size_t position() const { return at_; }

  // The line's next word as a number. Throws InputError, as fail() does, for others, and what is not finite;
  // what: "coordinate".
  Real number(const char* what);
  // The word as a whole number of any sign that has 64 bits.
  std::int64_t to_integer(std::string_view word, const char* what) const;
  // "file:line: trouble", of the line of the last word.
  [[noreturn]] void fail(const std::string& trouble) const;

 private:
  void skip_blanks(bool over_lines);
  std::string_view take_word();

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1, word_line_ = 1;
};

// A word of any length, for a message.
std::string quoted(std::string_view word);
// In small letters.
std::string lower(std::string_view word);

}  // namespace scree
