// Meshes: generated or read, checked, prepared for contacts.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/error.hpp"
#include "base/host_memory.hpp"
#include "mesh/coarsen.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/mesh_repair.hpp"
#include "mesh/refine.hpp"
#include "mesh/shell_crossings.hpp"
#include "mesh/surface_mesh.hpp"
#include "mesh/surface_numbers.hpp"
#include "mesh/weld.hpp"
#include "model/builder/build_parts.hpp"
#include "model/builder/fit_segments.hpp"
#include "model/builder/make_mesh.hpp"

namespace scree {
namespace {

// The key to name in messages about the mesh.
std::string source_key(const DeckTable& table) { return table.has("file") ? "file" : "kind"; }

[[noreturn]] void fail(const DeckTable& table, const std::vector<std::string>& troubles,
                       const std::string& remedy = "") {
  table.fail(source_key(table),
             fmt::format("the mesh is no surface: {}{}", fmt::join(troubles, "; "), remedy));
}

// A closed line has free edges at its ends along z.
void check(const DeckTable& table, const TriangleMesh& mesh) {
  const bool open = is_open_surface(table) || table.choice<MeshKind>("kind") == MeshKind::line;
  const std::vector<std::string> troubles = mesh_defects(mesh, open);
  if (!troubles.empty()) fail(table, troubles);
}

// A triangle with edges up to L has at most the area of the equilateral one, sqrt(3) / 4 L^2.
void check_memory_of_refined(const DeckTable& table, const TriangleMesh& mesh) {
  const Real longest = table.real("refine"),
             least = mesh_area(mesh) / (std::sqrt(Real(3)) / 4 * longest * longest);
  const FreeMemory memory = free_memory();
  const Real free = std::min(memory.process.bytes, memory.host.bytes);
  if (kBytesPerTriangle * least > free)
    table.fail("refine",
               fmt::format("makes at least {:.3g} triangles, which take about {:.3g} GB; {:.3g} GB are free",
                           least, kBytesPerTriangle * least / 1e9, free / 1e9));
}

TriangleMesh made_finer(const DeckTable& table, const TriangleMesh& mesh) {
  check_memory_of_refined(table, mesh);
  try {
    return refined(mesh, table.real("refine"));
  } catch (const InputError& error) {
    table.fail("refine", error.what());
  }
}

CoarseMesh coarser(const DeckTable& table, const TriangleMesh& mesh, Real distance) {
  return coarsened(mesh, distance, table.real("feature_angle"));
}

// The largest of some smaller distances at which parts of the mesh stay apart, for a message; or "".
std::string fitting_distance(const DeckTable& table, const TriangleMesh& mesh) {
  constexpr int kMostTries = 6;
  Real distance = table.real("coarsen");
  for (int k = 0; k < kMostTries; ++k) {
    distance /= 2;
    if (!own_crossing(coarser(table, mesh, distance).mesh))
      return fmt::format("; {:.3g} keeps them apart", distance);
  }
  return "";
}

// The coarsened mesh. Surfaces that are close to each other may intersect after coarsening, which is an
// error.
TriangleMesh made_coarser(const DeckTable& table, const TriangleMesh& mesh, ModelMesh& note) {
  CoarseMesh coarse = coarser(table, mesh, table.real("coarsen"));
  const std::vector<std::string> troubles = mesh_defects(coarse.mesh, is_open_surface(table));
  if (!troubles.empty())
    table.fail("coarsen",
               fmt::format("is too large, the coarser mesh is no surface: {}", fmt::join(troubles, "; ")));
  if (const std::optional<OwnCrossing> crossing = own_crossing(coarse.mesh); crossing && !own_crossing(mesh))
    table.fail(
        "coarsen",
        fmt::format("is too large: it brings parts of the mesh together, which cut through each other, "
                    "first at ({:.6g}, {:.6g}, {:.6g}){}",
                    crossing->position.x, crossing->position.y, crossing->position.z,
                    fitting_distance(table, mesh)));
  note.triangles_before = mesh.triangles.size(), note.moved = coarse.moved;
  return std::move(coarse.mesh);
}

// Advice for a file that is not a solid, or "".
std::string sheet_remedy(const NumberedMesh& mesh) {
  if (!mesh_defects(repaired(mesh, true).mesh.mesh, true).empty()) return "";
  return "; sheet = true takes it as a surface that is touched from both sides and encloses nothing";
}

// Checks the mesh of a file and repairs it; the log names the repairs. note: receives the place where its
// shells intersect.
TriangleMesh checked_file(const DeckTable& table, const NumberedMesh& welded, ModelMesh& note, Log& log) {
  const bool sheet = is_open_surface(table);
  MeshRepair repair = repaired(welded, sheet);
  NumberedMesh& mesh = repair.mesh;
  const std::vector<std::string> troubles = mesh_defects(mesh.mesh, sheet, mesh.numbers);
  if (!troubles.empty()) fail(table, troubles, sheet ? "" : sheet_remedy(welded));
  if (const std::string text = repair_text(repair, sheet); !text.empty())
    log.warning(fmt::format("mesh \"{}\" ({}): {}", table.text("name"),
                            std::filesystem::path(table.text("file")).filename().string(), text));
  if (!sheet) note.crossing = crossing_text(mesh.mesh, mesh.numbers);
  return std::move(mesh.mesh);
}

// The mesh after welding and checks.
TriangleMesh checked(const DeckTable& table, const TriangleMesh& mesh, ModelMesh& note, Log& log) {
  if (table.has("weld"))  // from a file
    return checked_file(table, welded_within(mesh, table.real("weld")), note, log);
  TriangleMesh joined = welded(mesh);
  if (table.has("file")) return checked_file(table, numbered(std::move(joined)), note, log);
  check(table, joined);
  return joined;
}

// The mesh after checks, coarsening and refinement. note: receives the changes.
TriangleMesh checked_and_resized(const DeckTable& table, const TriangleMesh& mesh, ModelMesh& note,
                                 Log& log) {
  TriangleMesh surface = checked(table, mesh, note, log);
  if (table.has("coarsen")) surface = made_coarser(table, surface, note);
  return table.has("refine") ? made_finer(table, surface) : surface;
}

void check_features(const DeckTable& table, const SurfaceMesh& mesh) {
  const std::size_t features = mesh.parts.size() + mesh.features.size(),
                    most = std::size_t{1} << kFeatureBits;
  if (features > most)
    table.fail(source_key(table),
               fmt::format("the mesh has {} faces, edges and vertices; at most {} can be told apart",
                           features, most));
}

// The table with its missing segments or levels. note: receives the value that fits particles of radius
// `grain` [m], and whether it is used.
DeckTable with_fitting_segments(DeckTable table, Real grain, ModelMesh& note) {
  const FittingSegments fitting = fitting_segments_of(table, grain);
  if (fitting.key.empty()) return table;
  if (grain < kInfinity) note.fitting = fmt::format("{} = {}", fitting.key, fitting.value);
  note.is_fitted = !table.has(fitting.key);
  if (note.is_fitted)
    table.set(fitting.key, {fitting.value, table.location(), std::to_string(fitting.value)});
  return table;
}

}  // namespace

void check_surface_count(const DeckTable& deck, const Model& model) {
  if (model.meshes.empty()) return;
  std::size_t surfaces = model.walls.size();
  for (const Body& body : model.bodies) surfaces += body.shapes.size() + body.meshes.size();
  constexpr std::size_t kMost = std::size_t{1} << kSurfaceBits;
  if (surfaces > kMost)
    throw InputError(fmt::format(
        "{}: the deck has {} walls, shapes and meshes of bodies; with meshes there can be at most {}",
        deck.tables("meshes").front().label(), surfaces, kMost));
}

void build_meshes(const DeckTable& deck, Model& model, ModelNames& names, Log& log) {
  const DeckTable& space = deck.table("space");
  const bool planar = space.integer("dimension") == 2;
  // Particles stay away from the ends of a line along z.
  const Real half_depth = norm(space.vector("max") - space.vector("min"));
  const Real grain = any_round(deck) ? smallest_particle_radius(deck) : kInfinity;
  for (const DeckTable& given : deck.tables("meshes")) {
    ModelMesh made{given.text("name"), nullptr};
    const DeckTable table = with_fitting_segments(given, grain, made);
    if (planar != (table.choice<MeshKind>("kind") == MeshKind::line))
      table.fail("kind",
                 planar ? "must be \"line\", as space.dimension = 2" : "\"line\" needs space.dimension = 2");
    add_name(names.meshes, table.text("name"), static_cast<int>(model.meshes.size()), table);
    const TriangleMesh line_solid = planar ? make_line_solid(table) : TriangleMesh{};
    const MadeMesh drawn = make_mesh(table, half_depth);
    // A line was refined when it was generated.
    const TriangleMesh mesh = planar ? checked(table, drawn.triangles, made, log)
                                     : checked_and_resized(table, drawn.triangles, made, log);
    made.surface = std::make_shared<const SurfaceMesh>(
        build_surface_mesh(mesh, table.real("feature_angle"), is_open_surface(table)));
    check_features(table, *made.surface);
    made.deviation = drawn.deviation.value_or(made.surface->curvature.sag);
    made.deviation_is_exact = drawn.deviation.has_value();
    model.meshes.push_back(made);
    names.triangles.push_back({planar ? line_solid : mesh, is_open_surface(table), planar, made.crossing});
  }
}

}  // namespace scree
