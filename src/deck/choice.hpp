// A choice of the deck: the words that a key takes, each beside the value of an enum that it stands for.
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

// All words of an enum, in the order of messages and manual: specialised beside the enum (deck/choices.hpp).
template <class Value>
inline constexpr std::array<Word<Value>, 0> kNoWords{};
template <class Value>
inline constexpr auto kWords = kNoWords<Value>;

// Whether there are words, and no word and no value stands there twice.
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

// Throws std::logic_error where the value has no word.
template <class Value>
std::string word_of(Value value) {
  for (const Word<Value>& word : kWords<Value>)
    if (word.value == value) return std::string(word.text);
  throw std::logic_error("deck: no word for value " + std::to_string(static_cast<int>(value)));
}

// Throws std::logic_error where no value has this word: never another value.
template <class Value>
Value value_of(std::string_view text) {
  for (const Word<Value>& word : kWords<Value>)
    if (word.text == text) return word.value;
  throw std::logic_error("deck: no value for the word \"" + std::string(text) + "\"");
}

}  // namespace scree
