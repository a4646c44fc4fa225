#include "deck/overrides.hpp"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "deck/nesting.hpp"
#include "deck/suggestion.hpp"

namespace scree {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string> split_path(const std::string& path, const std::string& location) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', start)) {
    parts.push_back(trimmed(path.substr(start, dot - start)));
    start = dot + 1;
  }
  parts.push_back(trimmed(path.substr(start)));
  if (parts.size() > kMostKeyParts)
    throw InputError(fmt::format("{}: a key of more than {} parts", location, kMostKeyParts));
  for (const std::string& part : parts)
    if (part.empty()) throw InputError(location + ": must have the form key.path=value");
  return parts;
}

// A table { value = ... } whose nodes have the override as their source.
toml::table parse_value(const std::string& text, const std::string& location) {
  if (line_of_deep_key(text) > 0)
    throw InputError(fmt::format("{}: a key of more than {} parts", location, kMostKeyParts));
  try {
    return toml::parse("value = " + text, std::string_view(location));
  } catch (const toml::parse_error& error) {
    const bool bare = !text.empty() &&
                      std::string_view("\"'[{").find(text.front()) == std::string_view::npos &&
                      text.find_first_of("'\n") == std::string::npos;
    if (!bare) throw InputError(fmt::format("{}: not a TOML value: {}", location, error.description()));
  }
  return toml::parse(fmt::format("value = '{}'", text), std::string_view(location));
}

// The element of a list of tables with this `name`, or with this number.
toml::table& element(toml::array& list, const std::string& id, const std::string& location) {
  std::vector<std::string> names;
  for (toml::node& node : list) {
    toml::table* table = node.as_table();
    const auto name = table ? (*table)["name"].value<std::string>() : std::nullopt;
    if (name == id) return *table;
    if (name) names.push_back(*name);
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  const bool numeric = error == std::errc() && end == id.data() + id.size();
  if (numeric && number < list.size() && list[number].is_table()) return *list[number].as_table();
  const std::string count = list.size() == 1 ? "is 1 element" : fmt::format("are {} elements", list.size());
  if (numeric) throw InputError(fmt::format("{}: there {}, counted from 0", location, count));
  throw InputError(fmt::format("{}: no element is named \"{}\"{}", location, id, suggestion(id, names)));
}

}  // namespace

void apply_override(toml::table& deck, const std::string& override_text) {
  constexpr std::size_t kLongest = 200;  // [B]
  const std::string location = "--set " + shortened(override_text, kLongest);
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos) throw InputError(location + ": must have the form key.path=value");
  const std::vector<std::string> path = split_path(override_text.substr(0, equals), location);
  toml::table parsed = parse_value(trimmed(override_text.substr(equals + 1)), location);
  if (parsed.size() != 1) throw InputError(location + ": must be one value");
  toml::table* table = &deck;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (!table->contains(path[i])) {
      table->insert_or_assign(path[i], std::move(*parse_value("{}", location).get("value")));
    }
    toml::node* node = table->get(path[i]);
    if (toml::array* list = node->as_array(); list && i + 2 < path.size()) {
      table = &element(*list, path[++i], location);
    } else if (node->is_table()) {
      table = node->as_table();
    } else {
      throw InputError(fmt::format("{}: {} has no keys of its own", location, path[i]));
    }
  }
  table->insert_or_assign(path.back(), std::move(*parsed.get("value")));
}

}  // namespace scree
