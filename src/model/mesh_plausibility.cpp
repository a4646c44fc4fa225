#include "model/mesh_plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "mesh/facets.hpp"
#include "model/limits.hpp"
#include "model/plausibility.hpp"
#include "physics/plausible.hpp"

namespace scree {
namespace {

constexpr Real kMostOfCurve = 0.5;  // radius of a particle over that of a concave surface
constexpr Real kMostSag = 0.1;      // over the largest overlap: so far the force errs where it is greatest
constexpr Real kMostTrianglesNear = 64;
constexpr Real kMostOfSpace = 10;  // the length of a mesh

// Sums over the triangles [m^2], [m].
struct MeshSize {
  Real area = 0, perimeters = 0;
};

MeshSize size_of(const SurfaceMesh& mesh) {
  MeshSize size;
  for (const MeshTriangle& triangle : mesh.triangles) {
    const Vec3 a = mesh.vertices[triangle.vertex[0]], b = mesh.vertices[triangle.vertex[1]],
               c = mesh.vertices[triangle.vertex[2]];
    size.area += norm(cross(b - a, c - a)) / 2;
    size.perimeters += norm(b - a) + norm(c - b) + norm(a - c);
  }
  return size;
}

// Of a line, which is drawn along z [m].
Real length_of(const SurfaceMesh& line) { return size_of(line).area / (line.box.max.z - line.box.min.z); }

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

// Pairs of one of the materials with one that particles have.
std::vector<PairLimit> limits_with_particles(const Model& model, const std::set<int>& materials) {
  const std::vector<MaterialUse> uses = material_uses(model);
  std::vector<PairLimit> limits = pair_limits(model);
  std::erase_if(limits, [&](const PairLimit& limit) {
    const auto is_on = [&](int side) {
      return materials.contains(limit.material[side]) &&
             uses[static_cast<std::size_t>(limit.material[1 - side])].particles > 0;
    };
    return !is_on(0) && !is_on(1);
  });
  return limits;
}

// The largest that impacts on one of the materials make; 0 where nothing moves [m].
Real largest_overlap(const Model& model, const std::set<int>& materials) {
  Real largest = 0;
  for (const PairLimit& limit : limits_with_particles(model, materials))
    largest = std::max(largest, impact_overlap(limit.law, lightest_mass(limit), impact_speed(model, limit)));
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
  const Real sag = mesh.deviation, overlap = largest_overlap(model, materials);
  if (overlap > 0 && mesh.moved > std::max(sag, kMostSag * overlap))
    return fmt::format(
        "mesh \"{}\": coarsen leaves the file's vertices up to {:.3g} m beside it, {:.0f} % of the {:.3g} m "
        "by "
        "which impacts overlap it, and forces err by as much: a smaller coarsen",
        mesh.name, mesh.moved, 100 * mesh.moved / overlap, overlap);
  if (overlap == 0 || mesh.is_fitted || !(sag > kMostSag * overlap)) return "";
  return fmt::format(
      "mesh \"{}\": its facets are up to {:.3g} m beside the smooth surface that they stand for, {:.0f} % of "
      "the {:.3g} m by which impacts overlap it, and forces err by as much: facets of half the length have a "
      "quarter",
      mesh.name, sag, 100 * sag / overlap, overlap);
}

// What makes a mesh of this table coarser.
std::string coarser(const DeckTable& table, const ModelMesh& mesh, Real smallest_radius) {
  if (table.has("refine")) return "a larger refine";
  if (table.has("file")) return fmt::format("coarsen = {:.2g}", kFacetShare * smallest_radius);
  return mesh.fitting.empty() || mesh.is_fitted ? "a smaller contact.skin" : mesh.fitting;
}

std::string too_fine(const Model& model, const ModelMesh& mesh, const DeckTable& table) {
  const ParticleTotals& particles = model.particles.totals;
  const Real near = triangles_near(model, *mesh.surface, particles.largest_radius);
  if (!(near > kMostTrianglesNear)) return "";
  return fmt::format(
      "mesh \"{}\": its triangles are small beside the particles: one of radius {:.3g} m that touches it is "
      "near "
      "about {:.2g} of them, and each costs time: {}",
      mesh.name, particles.largest_radius, near, coarser(table, mesh, particles.smallest_radius));
}

// What contacts of a fold need, of the pair of materials that overlaps the farthest beyond it: by how much
// its stiffness is too low.
struct FoldNeed {
  Real factor = 0;   // of the stiffness
  Real overlap = 0;  // [m]
  PairLimit limit;
};

// r: of the smallest particle; most: overlap that the fold allows [m].
FoldNeed need_of_fold(const Model& model, const std::set<int>& materials, Real most) {
  FoldNeed need;
  for (const PairLimit& limit : limits_with_particles(model, materials)) {
    const Real impact = impact_overlap(limit.law, lightest_mass(limit), impact_speed(model, limit)),
               rest = resting_overlap(limit.law, weight_at_bottom(model)), n = limit.law.exponent;
    const Real factor = std::max(std::pow(impact / most, n + 1), std::pow(rest / most, n));
    if (factor > need.factor) need = {factor, std::max(impact, rest), limit};
  }
  return need;
}

std::string sharp_folds(const Model& model, const ModelMesh& mesh, const std::set<int>& materials) {
  const MeshFold& fold = mesh.surface->fold;
  if (fold.angle == 0) return "";
  const Real share = 1 - std::cos(fold.angle), radius = model.particles.totals.smallest_radius;
  const FoldNeed need = need_of_fold(model, materials, share * radius);
  if (!(need.factor > 1)) return "";
  const auto [one, other] = need.limit.material;
  const std::vector<std::string>& names = model.contact.material_names;
  const bool has_moduli = model.contact.law(one, other).effective_modulus > 0;
  return fmt::format(
      "mesh \"{}\": its faces turn inwards by {:.3g} degrees at ({:.4g}, {:.4g}, {:.4g}) in its own frame, "
      "and "
      "contact \"{}\" on \"{}\" overlaps by up to {:.3g} of the smallest radius, {:.3g} m: past {:.2g} a "
      "contact "
      "with one side of such a fold ends at once, and impacts there lose or gain energy; {}",
      mesh.name, fold.angle * 180 / std::numbers::pi_v<Real>, fold.position.x, fold.position.y,
      fold.position.z, names[static_cast<std::size_t>(one)], names[static_cast<std::size_t>(other)],
      need.overlap / radius, radius, share,
      has_moduli
          ? fmt::format("moduli {:.2g} times as high would do", need.factor)
          : fmt::format("a stiffness of {:.3g} N/m{} would do", need.factor * need.limit.law.normal_stiffness,
                        need.limit.law.exponent == 1 ? "" : fmt::format("^{}", need.limit.law.exponent)));
}

std::string crossing_shells(const ModelMesh& mesh) {
  if (mesh.crossing.empty()) return "";
  return fmt::format(
      "mesh \"{}\": {}: within what they share, what touches the mesh is taken to be outside, and its volume "
      "counts "
      "twice; unite the shells in the program that the file comes from",
      mesh.name, mesh.crossing);
}

// Of a wall whose mesh has no face along which its surface could run.
std::string runs_across(const Model& model, const Wall& wall) {
  constexpr Real kRoundOff = 1e-9;
  if (wall.mesh < 0 || !wall.runs()) return "";
  const std::vector<MeshPart>& parts = model.meshes[static_cast<std::size_t>(wall.mesh)].surface->parts;
  const auto is_across = [&](const MeshPart& part) {
    return norm(cross(wall.surface_velocity, part.normal)) <= kRoundOff * norm(wall.surface_velocity);
  };
  if (!std::ranges::all_of(parts, is_across)) return "";
  return fmt::format(
      "wall \"{}\": its surface_velocity is across every face of its mesh, and takes nothing along: a "
      "surface "
      "runs along itself",
      wall.name);
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

// Within a distance of a point of a plane that is cut into triangles are on average as many of these as have
// the point within their outlines widened by that distance: the area of such an outline is that of the
// triangle, its perimeter times the distance, and a disc.
Real triangles_near(const Model& model, const SurfaceMesh& mesh, Real radius) {
  const Real reach = radius + model.contact.reach + model.contact.skin;
  const Real within = std::sqrt(reach * reach - radius * radius);
  const auto count = static_cast<Real>(mesh.triangles.size());
  if (model.space.dimension == 2) {
    const Real segments = count / 2;
    return std::min(1 + 2 * within * segments / length_of(mesh), segments);
  }
  const MeshSize size = size_of(mesh);
  const Real discs = count * std::numbers::pi_v<Real> * within * within;
  return std::min(1 + (size.perimeters * within + discs) / size.area, count);
}

Real triangles_wide(const Model& model, const SurfaceMesh& mesh, Real radius) {
  const auto count = static_cast<Real>(mesh.triangles.size());
  if (model.space.dimension == 2) return 2 * radius * count / 2 / length_of(mesh);
  return 2 * radius / std::sqrt(2 * size_of(mesh).area / count);
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
    if (!materials[m].empty()) findings.push_back(crossing_shells(mesh));
    if (materials[m].empty() || model.particles.totals.count == 0) continue;
    for (const std::string& finding :
         {too_narrow(model, mesh), too_coarse(model, mesh, materials[m]),
          too_fine(model, mesh, deck.tables("meshes")[m]), sharp_folds(model, mesh, materials[m])})
      findings.push_back(finding);
  }
  for (const Wall& wall : model.walls) findings.push_back(runs_across(model, wall));
  std::erase(findings, "");
  return findings;
}

}  // namespace scree
