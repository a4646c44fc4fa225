#include "deck/suggestion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <string_view>

#include "deck/synonyms.hpp"

namespace scree {

namespace {

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

// Number of letters to insert, delete or replace, or of neighbours to exchange; case is ignored.
std::size_t edit_distance(const std::string& one, const std::string& other) {
  const std::string a = lower(one), b = lower(other);
  std::vector<std::size_t> row(b.size() + 1), above(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), row[j] + 1, next[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], above[j - 2] + 1);
    }
    above.swap(row), row.swap(next);
  }
  return row[b.size()];
}

// Whether `one` is the singular of `several`: "mesh" and "meshes".
bool is_singular_of(const std::string& one, const std::string& several) {
  constexpr std::size_t kShortest = 3;
  return one.size() >= kShortest && (lower(one) + "s" == several || lower(one) + "es" == several);
}

// Whether two names differ by one letter or a quarter of them, or are singular and plural. Two different
// single letters are not close.
bool is_close(const std::string& a, const std::string& b) {
  const std::size_t letters = std::max(a.size(), b.size()), edits = edit_distance(a, b);
  return is_singular_of(a, b) || (edits < letters && edits <= std::max<std::size_t>(1, letters / 4));
}

std::string did_you_mean(std::string_view name) { return fmt::format("; did you mean \"{}\"?", name); }

// The closest name; empty where none is close.
std::string nearest(const std::string& misspelt, const std::vector<std::string>& names) {
  const auto found = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return edit_distance(misspelt, a) < edit_distance(misspelt, b);
  });
  return found != names.end() && is_close(misspelt, *found) ? *found : "";
}

// The one of `names` for which `said` is a synonym; empty where there is none.
std::string synonym(const std::string& said, const std::vector<std::string>& names,
                    std::span<const Synonym> synonyms) {
  for (const Synonym& each : synonyms) {
    const std::string name(each.meant.substr(each.meant.rfind('.') + 1));
    if (each.said == lower(said) && std::find(names.begin(), names.end(), name) != names.end()) return name;
  }
  return "";
}

// Path of a key for which `said` is a synonym, in any table. Single letters are ambiguous and excluded.
std::string_view path_of_synonym(const std::string& said) {
  for (const Synonym& each : kKeySynonyms)
    if (said.size() > 1 && each.said == lower(said)) return each.meant;
  return "";
}

}  // namespace

std::string suggestion(const std::string& misspelt, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  const std::string near = nearest(misspelt, names);
  if (!near.empty()) return did_you_mean(near);
  constexpr std::size_t kMost = 30;
  const auto last = names.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, names.size()));
  return fmt::format("; known: {}{}", fmt::join(names.begin(), last, ", "),
                     names.size() > kMost ? ", ..." : "");
}

std::string key_suggestion(const std::string& misspelt, const std::vector<std::string>& names) {
  const std::string here = synonym(misspelt, names, kKeySynonyms);
  if (!here.empty()) return did_you_mean(here);
  const std::string_view elsewhere = nearest(misspelt, names).empty() ? path_of_synonym(misspelt) : "";
  return elsewhere.empty() ? suggestion(misspelt, names) : did_you_mean(elsewhere);
}

std::string word_suggestion(const std::string& misspelt, const std::vector<std::string>& words) {
  const std::string meant = synonym(misspelt, words, kWordSynonyms);
  const std::string near = meant.empty() ? nearest(misspelt, words) : meant;
  return near.empty() ? "" : did_you_mean(near);
}

}  // namespace scree
