#include "model/mesh_plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "model/limits.hpp"
#include "model/plausibility.hpp"
#include "physics/plausible.hpp"

namespace scree {
namespace {

constexpr Real kMostOfCurve = 0.5;  // radius of a particle over that of a concave surface
constexpr Real kMostSag = 0.1;      // over the largest overlap: so far the force errs where it is greatest
constexpr Real kMostTrianglesNear = 64;
constexpr Real kMostOfSpace = 10;  // the length of a mesh

Real area_of(const SurfaceMesh& mesh) {
  Real area = 0;
  for (const MeshTriangle& triangle : mesh.triangles) {
    const Vec3 a = mesh.vertices[triangle.vertex[0]];
    area += norm(cross(mesh.vertices[triangle.vertex[1]] - a, mesh.vertices[triangle.vertex[2]] - a)) / 2;
  }
  return area;
}

// Meshes that walls and bodies have, or solids are made of.
std::set<std::string> used_meshes(const DeckTable& deck) {
  std::set<std::string> used;
  const auto use = [&](const std::vector<DeckTable>& tables) {
    for (const DeckTable& table : tables)
      if (table.has("mesh")) used.insert(table.text("mesh"));
  };
  use(deck.tables("walls"));
  for (const DeckTable& body : deck.tables("bodies")) use(body.tables("meshes")), use(body.tables("solids"));
  return used;
}

// Materials of the carriers of each mesh.
std::vector<std::set<int>> materials_of(const Model& model) {
  std::vector<std::set<int>> materials(model.meshes.size());
  for (const Wall& wall : model.walls)
    if (wall.mesh >= 0) materials[static_cast<std::size_t>(wall.mesh)].insert(wall.material);
  for (const Body& body : model.bodies)
    for (const MeshShape& shape : body.meshes)
      materials[static_cast<std::size_t>(shape.mesh)].insert(shape.material);
  return materials;
}

// The largest that impacts on one of the materials make; 0 where nothing moves [m].
Real largest_overlap(const Model& model, const std::set<int>& materials) {
  const std::vector<MaterialUse> uses = material_uses(model);
  const auto has_particles = [&](int material) {
    return uses[static_cast<std::size_t>(material)].particles > 0;
  };
  Real largest = 0;
  for (const PairLimit& limit : pair_limits(model))
    for (int side = 0; side < 2; ++side)
      if (materials.contains(limit.material[side]) && has_particles(limit.material[1 - side]))
        largest =
            std::max(largest, impact_overlap(limit.law, lightest_mass(limit), impact_speed(model, limit)));
  return largest;
}

// Of one whose file is in other units, mostly.
std::string too_large(const Model& model, const ModelMesh& mesh) {
  const auto longest = [](Vec3 a) { return std::max({a.x, a.y, a.z}); };
  const Vec3 space = model.space.max - model.space.min, size = mesh.surface->box.max - mesh.surface->box.min;
  const bool planar = model.space.dimension == 2;
  const Real of_space = longest(Vec3{space.x, space.y, planar ? 0 : space.z});
  const Real of_mesh = longest(Vec3{size.x, size.y, planar ? 0 : size.z});
  if (!(of_mesh > kMostOfSpace * of_space)) return "";
  return fmt::format(
      "mesh \"{}\": is {:.4g} m long, in a space of {:.4g} m: is its scale right? 0.001 takes a file in "
      "mm",
      mesh.name, of_mesh, of_space);
}

std::string too_narrow(const Model& model, const ModelMesh& mesh) {
  const Real curve = mesh.surface->curvature.concave_radius, radius = model.particles.totals.largest_radius;
  if (!(radius > kMostOfCurve * curve)) return "";
  return fmt::format(
      "mesh \"{}\": a particle of radius {:.3g} m is more than half as wide as the narrowest of its hollows, "
      "of radius about {:.3g} m: contacts on a smooth surface that point in about the same direction count "
      "once; a smaller feature_angle, or smaller particles",
      mesh.name, radius, curve);
}

std::string too_coarse(const Model& model, const ModelMesh& mesh, const std::set<int>& materials) {
  const Real sag = mesh.surface->curvature.sag, overlap = largest_overlap(model, materials);
  if (overlap > 0 && mesh.moved > std::max(sag, kMostSag * overlap))
    return fmt::format(
        "mesh \"{}\": coarsen leaves the file's vertices up to {:.3g} m beside it, {:.0f} % of the {:.3g} m "
        "by "
        "which impacts overlap it, and forces err by as much: a smaller coarsen",
        mesh.name, mesh.moved, 100 * mesh.moved / overlap, overlap);
  if (overlap == 0 || !(sag > kMostSag * overlap)) return "";
  return fmt::format(
      "mesh \"{}\": its facets are up to {:.3g} m beside the smooth surface that they stand for, {:.0f} % of "
      "the {:.3g} m by which impacts overlap it, and forces err by as much: facets of half the length have a "
      "quarter",
      mesh.name, sag, 100 * sag / overlap, overlap);
}

std::string too_fine(const Model& model, const ModelMesh& mesh) {
  const Real radius = model.particles.totals.largest_radius,
             near = triangles_near(model, *mesh.surface, radius);
  if (!(near > kMostTrianglesNear)) return "";
  return fmt::format(
      "mesh \"{}\": a particle of radius {:.3g} m that touches it is near about {:.3g} triangles, and each "
      "of "
      "them is looked at: a coarser mesh, or a smaller contact.skin",
      mesh.name, radius, near);
}

// Meshes meet neither walls nor each other.
std::string without_partners(const DeckTable& deck, const Model& model) {
  const bool meshes = std::ranges::any_of(model.bodies, [](const Body& b) { return !b.meshes.empty(); });
  const bool shapes = std::ranges::any_of(model.bodies, [](const Body& b) { return !b.shapes.empty(); });
  if (!meshes || shapes || !deck.tables("particles").empty()) return "";
  return "bodies have meshes, and the deck has nothing that these touch: particles, or discs and spheres of "
         "other bodies; meshes pass through walls and through each other";
}

}  // namespace

Real triangles_near(const Model& model, const SurfaceMesh& mesh, Real radius) {
  const Real reach = radius + model.contact.reach + model.contact.skin, area = area_of(mesh);
  const auto count = static_cast<Real>(mesh.triangles.size());
  const Real cap = std::numbers::pi_v<Real> * (reach * reach - radius * radius);
  if (model.space.dimension == 3) {
    // Those that the border of the disc cuts count, too: as if it were wider by one.
    const Real width = std::sqrt(cap * count / area) + 1;
    return std::min(width * width, count);
  }
  const Real length = area / (mesh.box.max.z - mesh.box.min.z);
  const Real segments = count / 2;
  return std::min(2 * std::sqrt(cap / std::numbers::pi_v<Real>) * segments / length + 1, segments);
}

std::vector<std::string> implausible_meshes(const DeckTable& deck, const Model& model) {
  std::vector<std::string> findings;
  if (std::string finding = without_partners(deck, model); !finding.empty())
    findings.push_back(std::move(finding));
  const std::set<std::string> used = used_meshes(deck);
  const std::vector<std::set<int>> materials = materials_of(model);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const ModelMesh& mesh = model.meshes[m];
    if (!used.contains(mesh.name))
      findings.push_back(fmt::format("mesh \"{}\": no wall, body or solid uses it", mesh.name));
    if (std::string finding = too_large(model, mesh); !finding.empty())
      findings.push_back(std::move(finding));
    if (materials[m].empty() || model.particles.totals.count == 0) continue;
    for (const std::string& finding :
         {too_narrow(model, mesh), too_coarse(model, mesh, materials[m]), too_fine(model, mesh)})
      if (!finding.empty()) findings.push_back(finding);
  }
  return findings;
}

}  // namespace scree
