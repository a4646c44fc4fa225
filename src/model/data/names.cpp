#include "model/data/names.hpp"

#include <fmt/format.h>

#include "deck/suggestion.hpp"

namespace scree {

namespace {

template <class Map>
std::vector<std::string> names_of(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

// "; "net" has net.0 to net.19" where the name is that of a row, or of an element beyond its end; otherwise
// "".
std::string elements_of_row(const NameMap& names, const std::string& name) {
  const auto has = [&](const std::string& row) { return names.contains(row + ".0"); };
  const std::string row = has(name) ? name : name.substr(0, name.rfind('.'));
  if (!has(row)) return "";
  int last = 0;
  while (names.contains(fmt::format("{}.{}", row, last + 1))) ++last;
  return fmt::format("; \"{0}\" has {0}.0 to {0}.{1}", row, last);
}

// known: further names that are valid, for the message.
[[noreturn]] void fail_for_name(const NameMap& names, const std::string& name, const DeckTable& table,
                                const std::string& key, const std::string& what,
                                std::vector<std::string> known) {
  const std::string row = elements_of_row(names, name);
  for (const std::string& of_map : names_of(names)) known.push_back(of_map);
  table.fail(key, fmt::format("there is no {} named \"{}\"{}", what, name,
                              row.empty() ? suggestion(name, known) : row));
}

}  // namespace

int find_name(const NameMap& names, const std::string& name, const DeckTable& table, const std::string& key,
              const std::string& what) {
  const auto found = names.find(name);
  if (found == names.end()) fail_for_name(names, name, table, key, what, {});
  return found->second;
}

int find_body(const ModelNames& names, const std::string& name, const DeckTable& table,
              const std::string& key) {
  if (name == kGroundName) return kGround;
  const auto found = names.bodies.find(name);
  if (found == names.bodies.end()) fail_for_name(names.bodies, name, table, key, "body", {kGroundName});
  return found->second;
}

int find_name(const NameMap& names, const DeckTable& table, const std::string& key, const std::string& what) {
  return find_name(names, table.text(key), table, key, what);
}

const std::vector<int>& find_row(const ModelNames& names, const std::string& name, const DeckTable& table,
                                 const std::string& key, std::vector<std::string> known) {
  const auto found = names.rows.find(name);
  if (found != names.rows.end()) return found->second;
  for (const std::string& row : names_of(names.rows)) known.push_back(row);
  table.fail(key,
             fmt::format("there is no body or row of bodies named \"{}\"{}", name, suggestion(name, known)));
}

const NamedMarker& find_marker(const ModelNames& names, const std::string& name, const DeckTable& table,
                               const std::string& key) {
  const auto found = names.markers.find(name);
  if (found != names.markers.end()) return found->second;
  table.fail(
      key, fmt::format("there is no marker named \"{}\"{}", name, suggestion(name, names_of(names.markers))));
}

int find_material(const ModelNames& names, const DeckTable& table, const std::string& key) {
  if (table.has(key)) return find_name(names.materials, table, key, "material");
  if (names.materials.size() == 1) return 0;
  table.fail(key, "missing; it must name a material, as the deck has more than one" +
                      suggestion("", names_of(names.materials)));
}

void add_name(NameMap& names, const std::string& name, int index, const DeckTable& table) {
  if (names.emplace(name, index).second) return;
  table.fail("name", fmt::format("the name \"{}\" is repeated; every name must be another one", name));
}

}  // namespace scree
