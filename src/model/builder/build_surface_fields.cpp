// Fields of the triangles of meshes in snapshots, and wear.
#include <fmt/format.h>

#include <algorithm>

#include "deck/suggestion.hpp"
#include "model/builder/build_parts.hpp"

namespace scree {

void build_surface_fields(const DeckTable& output, Model& model) {
  const char* const key = "surface_fields";
  const std::vector<std::string> known = words_of<SurfaceField>();
  for (const std::string& name : output.texts(key)) {
    if (std::ranges::find(known, name) == known.end())
      output.fail(key, fmt::format("there is no field \"{}\" of surfaces{}", name, suggestion(name, known)));
    const auto field = value_of<SurfaceField>(name);
    if (model.output.shows(field))
      output.fail(key, fmt::format("\"{}\" is repeated; every entry must be another one", name));
    model.output.surface_fields.push_back(field);
  }
  const bool any = std::ranges::any_of(model.walls, [](const Wall& wall) { return wall.mesh >= 0; }) ||
                   std::ranges::any_of(model.bodies, [](const Body& body) { return !body.meshes.empty(); });
  if (model.output.adds_up_works() && !any)
    output.fail(key, "only triangles have dissipation and wear, and no wall or body has a mesh");
  if (model.output.shows(SurfaceField::wear_depth) && model.contact.wear.empty())
    output.fail(key, "wear_depth needs a pair in contact.pairs with a wear_coefficient above 0");
}

}  // namespace scree
