#include "deck/differences.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "deck/former_names.hpp"
#include "deck/source_text.hpp"

namespace scree {

namespace {

class Comparison {
 public:
  void tables(const toml::table& before, const toml::table& after, const std::string& key,
              const std::string& pattern);
  std::vector<DeckDifference> found;

 private:
  void nodes(const toml::node* before, const toml::node* after, const std::string& key,
             const std::string& pattern);
  void lists(const toml::array& before, const toml::array& after, const std::string& key,
             const std::string& pattern);
};

std::string join(const std::string& path, std::string_view part) {
  return (path.empty() ? "" : path + ".") + std::string(part);
}

std::string shown_or_nothing(const toml::node* node) { return node == nullptr ? "nothing" : shown(*node); }

// Text is compared, not values: zeros with unequal signs have unequal bits.
std::string full_text(const toml::node* node) {
  std::ostringstream text;
  if (node != nullptr) node->visit([&](const auto& value) { text << value; });
  return text.str();
}

bool is_list_of_tables(const toml::node* node) {
  return node != nullptr && node->is_array() && !node->as_array()->empty() &&
         node->as_array()->front().is_table();
}

// The name of each element, or its number where it has no name.
std::vector<std::string> labels(const toml::array& list) {
  std::vector<std::string> result;
  for (const toml::node& entry : list)
    result.push_back(
        (*entry.as_table())["name"].value<std::string>().value_or(std::to_string(result.size())));
  return result;
}

void Comparison::tables(const toml::table& before, const toml::table& after, const std::string& key,
                        const std::string& pattern) {
  std::set<std::string_view> names;
  for (const toml::table* table : {&before, &after})
    for (const auto& [name, node] : *table) names.insert(name.str());
  for (const std::string_view name : names)
    nodes(before.get(name), after.get(name), join(key, name), join(pattern, name));
}

void Comparison::nodes(const toml::node* before, const toml::node* after, const std::string& key,
                       const std::string& pattern) {
  if (before != nullptr && after != nullptr && before->is_table() && after->is_table())
    return tables(*before->as_table(), *after->as_table(), key, pattern);
  if (is_list_of_tables(before) || is_list_of_tables(after)) {
    const toml::array none;
    return lists(before != nullptr ? *before->as_array() : none, after != nullptr ? *after->as_array() : none,
                 key, pattern);
  }
  if (full_text(before) != full_text(after))
    found.push_back({key, pattern, shown_or_nothing(before), shown_or_nothing(after)});
}

void Comparison::lists(const toml::array& before, const toml::array& after, const std::string& key,
                       const std::string& pattern) {
  const std::vector<std::string> old_labels = labels(before), new_labels = labels(after);
  if (old_labels != new_labels)
    found.push_back({key, pattern, fmt::format("[{}]", fmt::join(old_labels, ", ")),
                     fmt::format("[{}]", fmt::join(new_labels, ", "))});
  for (std::size_t i = 0; i < new_labels.size(); ++i) {
    const auto old = std::find(old_labels.begin(), old_labels.end(), new_labels[i]);
    if (old == old_labels.end()) continue;
    tables(*before[static_cast<std::size_t>(old - old_labels.begin())].as_table(), *after[i].as_table(),
           join(key, new_labels[i]), pattern + ".*");
  }
}

}  // namespace

std::vector<DeckDifference> deck_differences(const std::string& before, const std::string& after) {
  try {
    toml::table old_deck = toml::parse(before);
    FormerNames({}, "").replace(old_deck);
    Comparison comparison;
    comparison.tables(old_deck, toml::parse(after), "", "");
    return comparison.found;
  } catch (const toml::parse_error&) {
    return {{"", "", "another text", "this deck"}};
  }
}

std::string to_text(const DeckDifference& difference) {
  return fmt::format("{}: {} -> {}", difference.key, difference.before, difference.after);
}

}  // namespace scree
