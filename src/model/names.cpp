#include "model/names.hpp"

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

}  // namespace

int find_name(const NameMap& names, const std::string& name, const DeckTable& table, const std::string& key,
              const std::string& what) {
  const auto found = names.find(name);
  if (found != names.end()) return found->second;
  table.fail(key,
             fmt::format("there is no {} named \"{}\"{}", what, name, suggestion(name, names_of(names))));
}

int find_name(const NameMap& names, const DeckTable& table, const std::string& key, const std::string& what) {
  return find_name(names, table.text(key), table, key, what);
}

const std::vector<int>& find_row(const ModelNames& names, const std::string& name, const DeckTable& table,
                                 const std::string& key) {
  const auto found = names.rows.find(name);
  if (found != names.rows.end()) return found->second;
  table.fail(key, fmt::format("there is no body or row of bodies named \"{}\"{}", name,
                              suggestion(name, names_of(names.rows))));
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
