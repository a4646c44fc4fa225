#include "model/checks/mesh_plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "mesh/facets.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/checks/limits.hpp"
#include "model/checks/loose_meshes.hpp"
#include "model/checks/plausibility.hpp"
#include "model/derived/connections.hpp"
#include "physics/plausible.hpp"

namespace scree {
namespace {

constexpr Real kMostOfCurve = 0.5;  // radius of a particle relative to that of a concave surface
constexpr Real kMostSag = 0.1;  // relative to the largest overlap: the relative error of the largest force
constexpr Real kMostTrianglesNear = 24;  // number within range at a contact
constexpr Real kMostOfSpace = 10;        // extent of a mesh relative to the domain

// Sums over all triangles [m^2], [m].
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

// Length of a line, whose mesh is extruded along z [m].
Real length_of(const SurfaceMesh& line) { return size_of(line).area / (line.box.max.z - line.box.min.z); }

// Names of the meshes that walls, bodies or solids use.
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

// Materials of the owners of each mesh.
std::vector<std::set<int>> materials_of(const Model& model) {
  std::vector<std::set<int>> materials(model.meshes.size());
  for (const Wall& wall : model.walls)
    if (wall.mesh >= 0) materials[static_cast<std::size_t>(wall.mesh)].insert(wall.material);
  for (const Body& body : model.bodies)
    for (const MeshShape& shape : body.meshes)
      materials[static_cast<std::size_t>(shape.mesh)].insert(shape.material);
  return materials;
}

// Limits of the pairs of one of the materials with a material of particles.
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

// The largest overlap of impacts on one of the materials; 0 where nothing moves [m].
Real largest_overlap(const Model& model, const std::set<int>& materials) {
  Real largest = 0;
  const ImpactSpeeds speeds(model);
  for (const PairLimit& limit : limits_with_particles(model, materials))
    largest = std::max(largest, impact_overlap(limit.law, lightest_mass(limit), speeds.of(limit)));
  return largest;
}

// A mesh far larger than the domain, usually a file in other units.
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
      "mesh \"{}\": a particle of radius {:.3g} m is more than half as wide as its narrowest concave part, "
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
  // Not finer than the default.
  const Real fitting =
      mesh.deviation_is_exact ? kRelativeFacetError * model.particles.totals.smallest_radius : 0;
  if (overlap == 0 || !(sag > std::max(kMostSag * overlap, fitting))) return "";
  return fmt::format(
      "mesh \"{}\": its facets are up to {:.3g} m beside the smooth surface that they stand for, {:.0f} % of "
      "the {:.3g} m by which impacts overlap it, and forces err by as much: facets of half the length have a "
      "quarter",
      mesh.name, sag, 100 * sag / overlap, overlap);
}

// Advice for making a mesh of this table coarser.
std::string coarser(const DeckTable& table, const ModelMesh& mesh, Real smallest_radius) {
  if (table.has("refine")) return "a larger refine";
  if (table.has("file")) return fmt::format("coarsen = {:.2g}", kRelativeFacetError * smallest_radius);
  return mesh.fitting.empty() ? "a smaller contact.skin" : mesh.fitting;
}

std::string too_fine(const Model& model, const ModelMesh& mesh, const DeckTable& table) {
  const ParticleTotals& particles = model.particles.totals;
  const Real near = triangles_near(model, *mesh.surface, particles.largest_radius);
  if (mesh.is_fitted || !(near > kMostTrianglesNear)) return "";
  return fmt::format(
      "mesh \"{}\": its triangles are small beside the particles: one of radius {:.3g} m that touches it is "
      "near "
      "about {:.2g} of them, and each costs time: {}",
      mesh.name, particles.largest_radius, near, coarser(table, mesh, particles.smallest_radius));
}

// Height above the lowest corner of the domain, against gravity [m].
Real height_of(const Model& model, Vec3 p) {
  const Vec3 g = model.gravity, low = p - model.space.min, high = model.space.max - p;
  const auto along = [](Real gravity, Real from_min, Real to_max) {
    return std::abs(gravity) * (gravity < 0 ? from_min : to_max);
  };
  const Real size = norm(g);
  return size > 0 ? (along(g.x, low.x, high.x) + along(g.y, low.y, high.y) + along(g.z, low.z, high.z)) / size
                  : 0;
}

// The highest point of a box.
Vec3 top_of(const Model& model, Vec3 low, Vec3 high) {
  const Vec3 g = model.gravity;
  return {g.x < 0 ? high.x : low.x, g.y < 0 ? high.y : low.y, g.z < 0 ? high.z : low.z};
}

// Height from which a particle can fall from the initially highest position to a mesh's fold, at the lowest
// position of the fold at t = 0 [m].
Real fall_to_fold(const Model& model, std::size_t mesh) {
  const Vec3 fold = model.meshes[mesh].surface->fold.position;
  Real lowest = kInfinity;
  for (const Wall& wall : model.walls)
    if (wall.mesh == static_cast<int>(mesh)) lowest = std::min(lowest, height_of(model, fold));
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes)
      if (shape.mesh == static_cast<int>(mesh))
        lowest = std::min(lowest,
                          height_of(model, to_global_point(model, static_cast<int>(b), shape.offset + fold)));
  const ParticleTotals& particles = model.particles.totals;
  return std::max<Real>(0, height_of(model, top_of(model, particles.lowest, particles.highest)) - lowest);
}

// Impact of the smallest or largest particle on a fold, with an object of infinite mass.
struct FoldImpact {
  Real factor = 0;           // factor by which the stiffness is too low
  Real overlap = 0, radius;  // [m]
  PairLimit limit;
};

// share: allowed overlap relative to the particle's radius; speed [m/s].
FoldImpact fold_impact(const Model& model, const PairLimit& limit, Real share, Real speed, bool largest) {
  const ParticleTotals& particles = model.particles.totals;
  const Real radius = largest ? particles.largest_radius : particles.smallest_radius,
             mass = largest ? particles.largest_mass : particles.smallest_mass, n = limit.law.exponent;
  NormalLawParameters law = limit.law;  // of the smallest partners
  if (model.contact.law(limit.material[0], limit.material[1]).effective_modulus > 0)
    law.normal_stiffness *= std::sqrt(radius / particles.smallest_radius);
  const Real impact = impact_overlap(law, mass, speed), rest = static_overlap(law, weight_at_bottom(model));
  const Real most = share * radius;
  return {std::max(std::pow(impact / most, n + 1), std::pow(rest / most, n)), std::max(impact, rest), radius,
          limit};
}

// The impact with the largest excess of overlap. fall: height above the fold [m]; speeds are the largest in
// the model, except for the height of falling particles.
FoldImpact worst_on_fold(const Model& model, const std::set<int>& materials, Real share, Real fall) {
  const Real top = height_of(model, top_of(model, model.space.min, model.space.max)),
             not_fallen = fall_speed(norm(model.gravity), std::max<Real>(0, top - fall));
  FoldImpact worst{};
  const ImpactSpeeds speeds(model);
  for (const PairLimit& limit : limits_with_particles(model, materials)) {
    const Real fastest = speeds.of(limit),
               speed = std::sqrt(std::max<Real>(0, fastest * fastest - not_fallen * not_fallen));
    for (const bool largest : {false, true}) {
      const FoldImpact impact = fold_impact(model, limit, share, speed, largest);
      if (impact.factor > worst.factor) worst = impact;
    }
  }
  return worst;
}

std::string sharp_folds(const Model& model, std::size_t number, const std::set<int>& materials) {
  const ModelMesh& mesh = model.meshes[number];
  const MeshFold& fold = mesh.surface->fold;
  if (fold.angle == 0) return "";
  const Real share = 1 - std::cos(fold.angle);
  const FoldImpact worst = worst_on_fold(model, materials, share, fall_to_fold(model, number));
  if (!(worst.factor > 1)) return "";
  const Real enough = Real(1.01) * worst.factor;  // stays sufficient with the printed digits
  const auto [one, other] = worst.limit.material;
  const std::vector<std::string>& names = model.contact.material_names;
  const NormalLawParameters& law = worst.limit.law;
  const bool has_moduli = model.contact.law(one, other).effective_modulus > 0;
  return fmt::format(
      "mesh \"{}\": it has a concave edge of {:.3g} degrees at ({:.4g}, {:.4g}, {:.4g}) in its own frame, "
      "and contacts \"{}\" on \"{}\" overlap by up to {:.3g} of the radius, {:.3g} m: past {:.2g} a contact "
      "with one side of such a fold ends at once, and impacts there lose or gain energy; {} would do",
      mesh.name, fold.angle * 180 / std::numbers::pi_v<Real>, fold.position.x, fold.position.y,
      fold.position.z, names[static_cast<std::size_t>(one)], names[static_cast<std::size_t>(other)],
      worst.overlap / worst.radius, worst.radius, share,
      has_moduli ? fmt::format("moduli {:.3g} times as high", enough)
                 : fmt::format("a stiffness of {:.3g} N/m{}", enough * law.normal_stiffness,
                               law.exponent == 1 ? "" : fmt::format("^{}", law.exponent)));
}

std::string crossing_shells(const ModelMesh& mesh) {
  if (mesh.crossing.empty()) return "";
  return fmt::format(
      "mesh \"{}\": {}: within what they share, what touches the mesh is taken to be outside, and its volume "
      "counts "
      "twice; unite the shells in the program that the file comes from",
      mesh.name, mesh.crossing);
}

// Warning about a wall whose mesh has no face parallel to its surface velocity; otherwise empty.
std::string runs_across(const Model& model, const Wall& wall) {
  constexpr Real kRoundOff = 1e-9;
  if (wall.mesh < 0 || !wall.is_conveyor()) return "";
  const std::vector<MeshPart>& parts = model.meshes[static_cast<std::size_t>(wall.mesh)].surface->parts;
  const auto is_across = [&](const MeshPart& part) {
    return norm(cross(wall.surface_velocity, part.normal)) <= kRoundOff * norm(wall.surface_velocity);
  };
  if (!std::ranges::all_of(parts, is_across)) return "";
  return fmt::format(
      "wall \"{}\": its surface_velocity is perpendicular to every face of its mesh and has no effect: only "
      "its tangential part counts",
      wall.name);
}

}  // namespace

// Average number of triangles within a distance of a point of a triangulated plane: the point lies within
// that distance of a triangle where it is inside the triangle's outline widened by the distance, whose area
// is that of the triangle, plus its perimeter times the distance, plus a disc.
Real triangles_near(const Model& model, const SurfaceMesh& mesh, Real radius) {
  const Real reach = radius + model.contact.interaction_range + model.contact.skin;
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
  std::vector<std::string> findings = loose_meshes(deck, model);
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
          too_fine(model, mesh, deck.tables("meshes")[m]), sharp_folds(model, m, materials[m])})
      findings.push_back(finding);
  }
  for (const Wall& wall : model.walls) findings.push_back(runs_across(model, wall));
  std::erase(findings, "");
  return findings;
}

}  // namespace scree
