// Choices of the deck: the words that a key accepts, and the enum values for which they stand.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

template <class Value>
struct Word {
  std::string_view text;
  Value value;
};

// All words of an enum, in the order in which messages and the manual list them. Specialised next to the enum
// (deck/choices.hpp).
template <class Value>
inline constexpr std::array<Word<Value>, 0> kNoWords{};
template <class Value>
inline constexpr auto kWords = kNoWords<Value>;
// Words of earlier versions that are still read. Specialised where there are any.
template <class Value>
inline constexpr auto kFormerWords = kNoWords<Value>;

// Whether the enum has words, and every word and every value occurs once.
template <class Value>
constexpr bool words_are_distinct() {
  for (const Word<Value>& one : kWords<Value>)
    for (const Word<Value>& other : kWords<Value>)
      if (&one != &other && (one.text == other.text || one.value == other.value)) return false;
  return !kWords<Value>.empty();
}

template <class Value>
std::vector<std::string> words_of() {
  static_assert(words_are_distinct<Value>());
  std::vector<std::string> words;
  for (const Word<Value>& word : kWords<Value>) words.emplace_back(word.text);
  return words;
}

struct FormerWord {
  std::string text, now;
};

template <class Value>
std::vector<FormerWord> former_words_of();

// Throws std::logic_error where the value has no word.
template <class Value>
std::string word_of(Value value) {
  for (const Word<Value>& word : kWords<Value>)
    if (word.value == value) return std::string(word.text);
  throw std::logic_error("deck: no word for value " + std::to_string(static_cast<int>(value)));
}
// A choice as a deck has it, for messages: key = "word".
template <class Value>
std::string setting(const std::string& key, Value value) {
  return key + " = \"" + word_of(value) + '"';
}

// Throws std::logic_error where no value has this word.
template <class Value>
Value value_of(std::string_view text) {
  for (const Word<Value>& word : kWords<Value>)
    if (word.text == text) return word.value;
  throw std::logic_error("deck: no value for the word \"" + std::string(text) + "\"");
}

template <class Value>
std::vector<FormerWord> former_words_of() {
  std::vector<FormerWord> words;
  for (const Word<Value>& former : kFormerWords<Value>)
    words.push_back({std::string(former.text), word_of(former.value)});
  return words;
}

}  // namespace scree
