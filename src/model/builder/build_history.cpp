// Objects whose contacts the history records.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "deck/suggestion.hpp"
#include "model/builder/build_parts.hpp"

namespace scree {

namespace {

constexpr const char* kKey = "history_contacts";

std::vector<int> walls_named(const Model& model, const std::string& name) {
  std::vector<int> walls;
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    if (model.walls[w].name == name) walls.push_back(static_cast<int>(w));
  return walls;
}

[[noreturn]] void fail_unknown(const DeckTable& table, const ModelNames& names, const Model& model,
                               const std::string& name) {
  if (name.size() == 5 && std::string("xyz").find(name[0]) != std::string::npos &&
      (name.substr(1) == "_min" || name.substr(1) == "_max"))
    table.fail(kKey, fmt::format("the side {0} is no wall; space.{0} = \"wall\" makes it one", name));
  std::vector<std::string> known;
  for (const auto& [row, bodies] : names.rows) known.push_back(row);
  for (const Wall& wall : model.walls) known.push_back(wall.name);
  for (const Body& body : model.bodies)
    for (const MeshShape& shape : body.meshes)
      known.push_back(body.name + "." + model.meshes[static_cast<std::size_t>(shape.mesh)].name);
  table.fail(
      kKey, fmt::format(
                "there is no body, row of bodies, mesh of a body, wall or side that is a wall named \"{}\"{}",
                name, suggestion(name, known)));
}

// "bucket.teeth": a mesh of a body, for every use of it by the body.
std::vector<ContactTarget> meshes_named(const ModelNames& names, const Model& model,
                                        const std::string& name) {
  std::vector<ContactTarget> found;
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return found;
  const auto body = names.bodies.find(name.substr(0, dot));
  if (body == names.bodies.end()) return found;
  const std::vector<MeshShape>& meshes = model.bodies[static_cast<std::size_t>(body->second)].meshes;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    if (model.meshes[static_cast<std::size_t>(meshes[m].mesh)].name == name.substr(dot + 1))
      found.push_back({name, {body->second}, false, -1, static_cast<int>(m)});
  return found;
}

// Description of a target for messages: "row of bodies \"net\"", "mesh \"teeth\" of body \"bucket\"".
std::string described(const Model& model, const ContactTarget& target) {
  if (target.wall >= 0) return fmt::format("wall \"{}\"", target.name);
  if (target.row) return fmt::format("row of bodies \"{}\"", target.name);
  const Body& body = model.bodies[static_cast<std::size_t>(target.bodies.front())];
  if (target.mesh < 0) return fmt::format("body \"{}\"", body.name);
  const int mesh = body.meshes[static_cast<std::size_t>(target.mesh)].mesh;
  return fmt::format("mesh \"{}\" of body \"{}\"", model.meshes[static_cast<std::size_t>(mesh)].name,
                     body.name);
}

ContactTarget target_of(const DeckTable& table, const ModelNames& names, const Model& model,
                        const std::string& name) {
  std::vector<ContactTarget> meanings = meshes_named(names, model, name);
  const auto body = names.bodies.find(name);
  const auto row = names.rows.find(name);
  if (body != names.bodies.end())
    meanings.push_back({name, {body->second}, false, -1});
  else if (row != names.rows.end())
    meanings.push_back({name, row->second, true, -1});
  for (const int wall : walls_named(model, name)) meanings.push_back({name, {}, false, wall});
  if (meanings.empty()) fail_unknown(table, names, model, name);
  if (meanings.size() == 1) return meanings.front();
  std::vector<std::string> shown;
  for (const ContactTarget& meaning : meanings) shown.push_back("of " + described(model, meaning));
  table.fail(kKey, fmt::format("\"{}\" is the name {}; it must be that of one: give one of them another name",
                               name, fmt::join(shown, " and ")));
}

}  // namespace

void build_history_contacts(const DeckTable& table, const ModelNames& names, Model& model) {
  std::vector<ContactTarget>& targets = model.output.history_contacts;
  for (const std::string& name : table.texts(kKey)) {
    const bool repeated =
        std::any_of(targets.begin(), targets.end(), [&](const ContactTarget& t) { return t.name == name; });
    if (repeated) table.fail(kKey, fmt::format("\"{}\" is repeated; every entry must be another one", name));
    targets.push_back(target_of(table, names, model, name));
  }
}

}  // namespace scree
