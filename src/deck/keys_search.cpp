#include "deck/keys_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "deck/keys.hpp"
#include "deck/suggestion.hpp"
#include "deck/synonyms.hpp"
#include "deck/wrapped.hpp"

namespace scree {

namespace {

constexpr std::size_t kWidth = 110;
constexpr const char* kLimits =
    "for the limits of the model see input/limits.md, the beginning of scree keys";

std::string small(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// The word in the form of keys: lower case, underscores for blanks and hyphens, singular.
std::string plain(std::string_view text) {
  std::string out = small(text);
  if (const std::size_t of = out.find("'s"); of != out.npos) out.erase(of, 2);
  std::ranges::replace_if(
      out, [](char c) { return c == ' ' || c == '-'; }, '_');
  if (out.size() > 4 && out.ends_with("ies")) return out.replace(out.size() - 3, 3, "y");
  if (out.size() > 3 && out.ends_with('s') && !out.ends_with("ss")) out.pop_back();
  return out;
}

// Whether the word occurs in the text at the beginning of a word.
bool has_word(std::string_view text, const std::string& word) {
  const std::string in = small(text);
  for (std::size_t at = in.find(word); at != in.npos; at = in.find(word, at + 1))
    if (at == 0 || std::isalnum(static_cast<unsigned char>(in[at - 1])) == 0) return true;
  return false;
}

struct Found {
  std::string path;
  const Key* key;
  std::string selector;
  int rank;  // below kNone
};

// Ranks of the match: in the path; in words, former names or synonyms; in the key's text.
constexpr int kPath = 0, kMeant = 1, kMeaning = 2, kNone = 3;

class Search {
 public:
  explicit Search(const std::string& word) : word_(plain(word)), spoken_(spoken(word_)) {
    for (const Synonym& one : kWordSynonyms)
      if (plain(one.said) == word_) words_.emplace_back(one.meant);
    for (const Synonym& one : kKeySynonyms) take(one);
    for (const Synonym& one : kTopics) take(one);
    collect(deck_keys(), "");
    collect(time_function_keys(), "(time function)");
    collect(distribution_keys(), "(distribution)");
    std::ranges::stable_sort(found_, {}, &Found::rank);
  }

  const std::vector<Found>& found() const { return found_; }
  const std::vector<std::string>& paths() const { return paths_; }
  const std::string& word() const { return word_; }

 private:
  static std::string spoken(std::string word) {
    std::ranges::replace(word, '_', ' ');
    return word;
  }
  void take(const Synonym& one) {
    if (plain(one.said) == word_) meant_.emplace_back(one.meant);
  }
  int rank_of(const std::string& path, const Key& key) const {
    if (has_word(path, word_)) return kPath;
    const auto has = [&](const std::string& word) {
      return has_word(word, word_) || std::ranges::find(words_, word) != words_.end();
    };
    const bool means = std::ranges::find(meant_, path) != meant_.end() ||
                       std::ranges::any_of(key.words, has) ||
                       std::ranges::any_of(key.former_names, has, &FormerName::text) ||
                       std::ranges::any_of(key.former_words, has, &FormerWord::text);
    if (means) return kMeant;
    return has_word(key.sentence, spoken_) ? kMeaning : kNone;
  }
  void collect(const TableKeys& table, const std::string& path) {
    for (const Key& key : table.keys) {
      const std::string own = path.empty() ? key.name : path + "." + key.name;
      paths_.push_back(own);
      if (const int rank = rank_of(own, key); rank < kNone)
        found_.push_back({own, &key, table.selector, rank});
      if (key.type == ValueType::table || key.type == ValueType::tables) collect(*key.table, own);
    }
  }

  std::string word_, spoken_;  // in the form of keys, and in that of sentences
  std::vector<std::string> words_, meant_, paths_;
  std::vector<Found> found_;
};

std::vector<std::string> words_of(const std::string& phrase) {
  std::vector<std::string> words;
  std::istringstream in(phrase);
  for (std::string word; in >> word;)
    if (word.size() > 2) words.push_back(word);  // without of, in, at
  return words;
}

// Keys that are found for every word of the phrase.
std::vector<Found> found_by_each(const std::vector<std::string>& words) {
  if (words.empty()) return {};
  std::vector<Found> found = Search(words.front()).found();
  for (std::size_t k = 1; k < words.size(); ++k) {
    const Search other(words[k]);
    std::erase_if(found, [&](const Found& one) {
      return std::ranges::find(other.found(), one.path, &Found::path) == other.found().end();
    });
  }
  return found;
}

std::string line_of(const Found& found) {
  const Key& key = *found.key;
  const bool is_table = key.type == ValueType::table || key.type == ValueType::tables;
  std::string text = is_table
                         ? (key.type == ValueType::table ? "[" + found.path + "]" : "[[" + found.path + "]]")
                         : found.path;
  text += "\n";
  if (!is_table) text += wrapped(key_facts(key, found.selector), kWidth, 6);
  const std::string& sentence = is_table ? key.table->sentence : key.sentence;
  return text + (sentence.empty() ? "" : wrapped(sentence, kWidth, 6));
}

std::string absent_text(const std::string& word) {
  for (const Synonym& one : kAbsent)
    if (plain(one.said) == word || word.starts_with(plain(one.said))) return std::string(one.meant);
  return "";
}

}  // namespace

std::string keys_about(const std::string& word) {
  const Search search(word);
  const std::string absent = absent_text(search.word());
  const std::vector<Found> found = search.found().empty() ? found_by_each(words_of(word)) : search.found();
  if (word.empty() || (found.empty() && absent.empty()))
    throw InputError(fmt::format("keys {}: no key is about this{}; {}", word,
                                 word_suggestion(search.word(), search.paths()), kLimits));
  std::string text;
  if (!absent.empty())
    text = wrapped(fmt::format("{}: not supported: {}; {}.", word, absent, kLimits), kWidth) + "\n";
  for (const Found& one : found) text += line_of(one);
  return text;
}

}  // namespace scree
