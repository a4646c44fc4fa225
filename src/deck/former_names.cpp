#include "deck/former_names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "deck/reader.hpp"

namespace scree {

namespace {

bool is_override(const toml::node& node) {
  return node.source().path && node.source().path->starts_with("--set ");
}

// Whether one --set has both values, in a table.
bool in_one_override(const toml::node& one, const toml::node& other) {
  return is_override(other) && *one.source().path == *other.source().path &&
         one.source().begin != other.source().begin;
}

}  // namespace

FormerNames::Paths FormerNames::Paths::below(const std::string& name, const std::string& in_pattern) const {
  return {join_path(path, name), join_path(pattern, in_pattern)};
}

void FormerNames::replace(toml::table& deck) { replace(deck, deck_keys(), {}); }

void FormerNames::replace(toml::table& table, const TableKeys& keys, const Paths& paths) {
  for (const Key& key : keys.keys) {
    for (const FormerName& former : key.former_names) replace_name(table, key, former, paths);
    toml::node* const node = table.get(key.name);
    if (node == nullptr) continue;
    const Paths own = paths.below(key.name, key.name);
    replace_word(*node, key, own);
    if (key.table == nullptr) continue;
    if (toml::table* inner = node->as_table()) replace(*inner, *key.table, own);
    if (toml::array* list = node->as_array()) {
      std::size_t number = 0;
      for (toml::node& element : *list) {
        const std::string count = std::to_string(number++);
        if (toml::table* inner = element.as_table())
          replace(*inner, *key.table, own.below((*inner)["name"].value_or(count), "*"));
      }
    }
  }
}

void FormerNames::replace_name(toml::table& table, const Key& key, const FormerName& former,
                               const Paths& paths) {
  const auto found = table.find(former.text);
  if (found == table.end()) return;
  toml::node& node = found->second;
  const toml::source_region region = found->first.source().path ? found->first.source() : node.source();
  const std::string location = location_of(region, path_), value = shown(node, source_);
  const Paths own = paths.below(former.text, former.text);
  const toml::node* const other = table.get(key.name);
  if (other != nullptr && (!is_override(node) || in_one_override(node, *other)))
    throw InputError(fmt::format("{}: {} = {}: is the former name of {}, which {} gives, too", location,
                                 own.path, value, key.name, location_of(other->source(), path_)));
  if (former.sense == FormerSense::negated && node.is_boolean())
    *node.as_boolean() = !node.as_boolean()->get();
  add(location, own, value, fmt::format("{} = {}", key.name, shown(node, source_)));
  table.erase(key.name);
  table.insert_or_assign(toml::key(key.name, toml::source_region(region)), std::move(node));
  table.erase(former.text);
}

void FormerNames::replace_word(toml::node& node, const Key& key, const Paths& paths) {
  if (!node.is_string()) return;
  std::string& text = node.as_string()->get();
  for (const FormerWord& former : key.former_words) {
    if (text != former.text) continue;
    add(location_of(node.source(), path_), paths, shown(node), '"' + former.now + '"');
    text = former.now;
    return;
  }
}

void FormerNames::add(const std::string& location, const Paths& former, const std::string& value,
                      const std::string& present) {
  const auto known = std::ranges::find(uses_, former.pattern, &Use::pattern);
  if (known != uses_.end()) {
    ++known->more;
    return;
  }
  uses_.push_back(
      {former.pattern, fmt::format("{}: {} = {} is now {}", location, former.path, value, present), 0});
}

std::vector<std::string> FormerNames::lines() const {
  std::vector<std::string> lines;
  for (const Use& use : uses_)
    lines.push_back(use.line + (use.more == 0   ? ""
                                : use.more == 1 ? "; so is 1 more"
                                                : fmt::format("; so are {} more", use.more)));
  return lines;
}

}  // namespace scree
