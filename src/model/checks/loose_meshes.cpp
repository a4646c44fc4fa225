#include "model/checks/loose_meshes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "model/derived/connections.hpp"
#include "model/derived/mesh_corners.hpp"

namespace scree {
namespace {

// Names of walls, the first few of them.
std::string some_of(const std::vector<std::string>& walls) {
  constexpr std::size_t kMost = 3;
  const std::size_t shown = std::min(walls.size(), kMost);
  return fmt::format("{}{}",
                     fmt::join(walls.begin(), walls.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     walls.size() > shown ? fmt::format(" and {} more", walls.size() - shown) : "");
}

// Whether the deck has a pair of the two materials, also one without forces.
bool pair_is_given(const DeckTable& deck, const Model& model, int a, int b) {
  const std::vector<std::string>& names = model.contact.material_names;
  const std::string &first = names[static_cast<std::size_t>(a)], &second = names[static_cast<std::size_t>(b)];
  return std::ranges::any_of(deck.table("contact").tables("pairs"), [&](const DeckTable& pair) {
    if (!pair.has("materials")) return true;
    const std::vector<std::string>& of = pair.texts("materials");
    return (of[0] == first && of[1] == second) || (of[0] == second && of[1] == first);
  });
}

// Bodies without joints that have only meshes, and the walls that they pass through though these may be meant
// to stop them.
class LooseMeshes {
 public:
  LooseMeshes(const DeckTable& deck, const Model& model) : deck_(deck), model_(model) {
    const std::vector<bool> held = held_bodies(model);
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const Body& body = model.bodies[b];
      if (held[b] || !body.shapes.empty() || body.meshes.empty()) continue;
      add(
          body, [&](const Wall& wall) { return touches_spheres(body, wall) && wall.mesh >= 0; }, meshes_);
      add(
          body, [&](const Wall& wall) { return has_no_law(body, wall); }, without_law_);
    }
  }
  std::string through_meshes() const {
    return finding(meshes_,
                   "it has meshes and no discs or spheres: meshes do not touch walls that are meshes",
                   "shapes beside the meshes, or a joint, keep it inside");
  }
  std::string through_planes() const {
    return finding(without_law_,
                   "contact.pairs has no law for its meshes there: they touch planes where there is one",
                   "a pair of the two materials, with stiffness = 0 where nothing is to stop it");
  }

 private:
  struct Passing {
    std::string body;  // the first such body
    std::vector<std::string> walls;
    std::size_t bodies = 0;
  };
  template <class Passes>
  void add(const Body& body, const Passes& passes, Passing& to) {
    std::vector<std::string> walls;
    for (const Wall& wall : model_.walls)
      if (passes(wall)) walls.push_back(fmt::format("\"{}\"", wall.name));
    if (walls.empty() || to.bodies++ > 0) return;
    to.body = body.name, to.walls = walls;
  }
  bool touches_spheres(const Body& body, const Wall& wall) const {
    return std::ranges::any_of(body.meshes, [&](const MeshShape& mesh) {
      return model_.contact.law(mesh.material, wall.material).acts();
    });
  }
  bool has_no_law(const Body& body, const Wall& wall) const {
    return wall.mesh < 0 && std::ranges::none_of(body.meshes, [&](const MeshShape& mesh) {
             return model_.contact.law(mesh.material, wall.material).acts() ||
                    pair_is_given(deck_, model_, mesh.material, wall.material);
           });
  }
  static std::string finding(const Passing& found, const char* reason, const char* remedy) {
    if (found.bodies == 0) return "";
    return fmt::format("body \"{}\": no joint holds it, and {}: it passes through {}{}; {}", found.body,
                       reason, some_of(found.walls),
                       found.bodies > 1 ? fmt::format(", and so do {} other bodies", found.bodies - 1) : "",
                       remedy);
  }

  const DeckTable& deck_;
  const Model& model_;
  Passing meshes_, without_law_;
};

// Meshes touch neither each other nor walls that are meshes.
std::string without_partners(const DeckTable& deck, const Model& model) {
  const auto any_body = [&](const auto& has) { return std::ranges::any_of(model.bodies, has); };
  const bool meshes = any_body([](const Body& b) { return !b.meshes.empty(); });
  const bool shapes = any_body([](const Body& b) { return !b.shapes.empty(); });
  if (!meshes || shapes || !deck.tables("particles").empty() || !model.inserters.empty() ||
      largest_corner_radius(model) > 0)
    return "";
  return "bodies have meshes, and the deck has nothing that these touch: particles, planes, or discs and "
         "spheres of other bodies; meshes pass through each other and through walls that are meshes";
}

}  // namespace

std::vector<std::string> loose_meshes(const DeckTable& deck, const Model& model) {
  const LooseMeshes loose(deck, model);
  return {without_partners(deck, model), loose.through_meshes(), loose.through_planes()};
}

}  // namespace scree
