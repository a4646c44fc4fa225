#include "model/builder/fit_segments.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "deck/choices.hpp"
#include "mesh/facets.hpp"
#include "model/builder/particle_file.hpp"
#include "model/derived/distribution.hpp"

namespace scree {

namespace {

Real smallest_of(const DeckTable& group, int dimension) {
  if (group.has("radius")) return read_distribution(group.table("radius"), dimension).smallest();
  if (group.choice<GroupKind>("kind") != GroupKind::file) return kInfinity;
  const ParticleFile file(group.text("file"), dimension);
  if (!file.has("radius") || file.count() == 0) return kInfinity;
  return std::ranges::min(file.read({0, file.count()}).at("radius"));
}

// Radius of the largest circle of a round shape; 0 for others [m].
Real largest_circle(const DeckTable& mesh) {
  switch (mesh.choice<MeshKind>("kind")) {
    case MeshKind::plate:
      return mesh.real("hole_radius");
    case MeshKind::cone:
    case MeshKind::funnel:
      return std::max(mesh.real("radius"), mesh.real("top_radius"));
    case MeshKind::cylinder:
    case MeshKind::sphere:
    case MeshKind::capsule:
    case MeshKind::pipe:
    case MeshKind::screw:
      return mesh.real("radius");
    case MeshKind::drum:
      return mesh.real("radius") + mesh.real("wall");
    default:
      return 0;
  }
}

}  // namespace

Real smallest_particle_radius(const DeckTable& deck) {
  const int dimension = static_cast<int>(deck.table("space").integer("dimension"));
  Real smallest = kInfinity;
  for (const DeckTable& group : deck.tables("particles")) {
    const Real radius = smallest_of(group, dimension);
    if (radius > 0) smallest = std::min(smallest, radius);
  }
  return smallest;
}

FittingSegments fitting_segments_of(const DeckTable& mesh, Real grain) {
  const Real radius = largest_circle(mesh);
  if (radius == 0) return {};
  if (mesh.choice<MeshKind>("kind") == MeshKind::sphere)
    return {"levels", grain < kInfinity ? fitting_levels(radius, grain) : kUsualLevels};
  return {"segments",
          grain < kInfinity ? fitting_segments(radius, grain, mesh.real("feature_angle")) : kUsualSegments};
}

bool any_round(const DeckTable& deck) {
  return std::ranges::any_of(deck.tables("meshes"),
                             [](const DeckTable& mesh) { return largest_circle(mesh) > 0; });
}

Deck with_fitting_segments(Deck deck) {
  std::vector<DeckTable> meshes = deck.root.tables("meshes");
  const auto is_cut = [](const DeckTable& mesh) {
    const FittingSegments usual = fitting_segments_of(mesh, kInfinity);
    return usual.key.empty() || mesh.has(usual.key);
  };
  if (std::ranges::all_of(meshes, is_cut)) return deck;
  const Real grain = smallest_particle_radius(deck.root);
  for (DeckTable& mesh : meshes) {
    if (is_cut(mesh)) continue;
    const FittingSegments fitting = fitting_segments_of(mesh, grain);
    mesh.set(fitting.key, {fitting.value, mesh.location(), std::to_string(fitting.value)});
  }
  deck.root.set("meshes", {std::move(meshes), deck.root.location(), "[]"});
  return deck;
}

}  // namespace scree
