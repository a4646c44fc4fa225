#include "deck/suggestion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace scree {

namespace {

// Levenshtein's distance: letters to insert, delete or replace.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string suggestion(const std::string& misspelt, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  const auto nearest = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return edit_distance(misspelt, a) < edit_distance(misspelt, b);
  });
  const std::size_t close = std::max<std::size_t>(2, misspelt.size() / 3);
  if (edit_distance(misspelt, *nearest) <= close) return fmt::format("; did you mean \"{}\"?", *nearest);
  constexpr std::size_t kMost = 30;
  const auto last = names.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, names.size()));
  return fmt::format("; known: {}{}", fmt::join(names.begin(), last, ", "),
                     names.size() > kMost ? ", ..." : "");
}

}  // namespace scree
