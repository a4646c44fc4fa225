// Meshes: made or read, checked, prepared for contacts.
#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/primitives.hpp"
#include "mesh/read_mesh.hpp"
#include "mesh/weld.hpp"
#include "model/build_parts.hpp"
#include "model/frames.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {
namespace {

Vec3 size_of(const DeckTable& table, std::size_t entries) {
  const std::vector<Real>& size = table.reals("size");
  if (size.size() != entries) table.fail("size", fmt::format("must have {} entries", entries));
  return {size[0], size[1], entries > 2 ? size[2] : 0};
}

Index segments_of(const DeckTable& table, Index multiple = 1) {
  const auto segments = static_cast<Index>(table.integer("segments"));
  if (segments % multiple != 0) table.fail("segments", fmt::format("must be a multiple of {}", multiple));
  return segments;
}

void check_smaller(const DeckTable& table, const std::string& key, const std::string& than) {
  if (!(table.real(key) < table.real(than))) table.fail(key, fmt::format("must be below {}", than));
}

TriangleMesh drum_of(const DeckTable& table) {
  const auto lifters = static_cast<Index>(table.integer("lifters"));
  for (const char* key : {"lifter_height", "lifter_width"})
    if ((lifters > 0) != table.has(key))
      table.fail(key, lifters > 0 ? "missing; lifters are given" : "not used without lifters");
  const Real height = lifters > 0 ? table.real("lifter_height") : 0,
             width = lifters > 0 ? table.real("lifter_width") : 0, radius = table.real("radius");
  if (lifters > 0 && !(height < radius)) table.fail("lifter_height", "must be below radius");
  if (!(lifters * width < 3 * radius))
    table.fail("lifter_width", "the lifters fill the drum's inside: must be below 3 radius / lifters");
  return drum_mesh({radius, table.real("wall"), table.real("length"), table.real("end_wall"), lifters, height,
                    width, segments_of(table)});
}

TriangleMesh screw_of(const DeckTable& table) {
  const Real length = table.real("length"), pitch = table.real("pitch"), thickness = table.real("thickness");
  const Real core = table.has("core_length") ? table.real("core_length") : length;
  check_smaller(table, "core_radius", "radius");
  if (!(core >= length)) table.fail("core_length", "must be at least length");
  if (!(thickness < std::abs(pitch))) table.fail("thickness", "must be below the size of pitch");
  return screw_mesh(
      {table.real("core_radius"), table.real("radius"), pitch, thickness, length, core, segments_of(table)});
}

// Its depth is that of the space's extent at least, so that no particle is near a free edge along z.
TriangleMesh line_of(const DeckTable& table, const Space& space) {
  const std::vector<Vec3>& points = table.vectors("points");
  const bool closed = table.boolean("closed");
  if (points.size() < (closed ? 3u : 2u))
    table.fail("points", fmt::format("must be at least {}", closed ? 3 : 2));
  return extruded_line_mesh(points, closed, norm(space.max - space.min));
}

TriangleMesh made(const DeckTable& table, const Space& space) {
  const auto radius = [&] { return table.real("radius"); };
  const auto length = [&] { return table.real("length"); };
  switch (table.choice<MeshKind>("kind")) {
    case MeshKind::file:
      return read_mesh(table.text("file"));
    case MeshKind::box:
      return box_mesh({size_of(table, 3)});
    case MeshKind::cylinder:
      return cylinder_mesh({radius(), length(), segments_of(table)});
    case MeshKind::cone:
      return cone_mesh({radius(), table.real("top_radius"), length(), segments_of(table)});
    case MeshKind::sphere:
      return sphere_mesh({radius(), static_cast<int>(table.integer("levels"))});
    case MeshKind::capsule:
      return capsule_mesh({radius(), length(), segments_of(table, 4)});
    case MeshKind::plate: {
      const Vec3 size = size_of(table, 3);
      if (!(2 * table.real("hole_radius") < std::min(size.x, size.y)))
        table.fail("hole_radius", "must be below half of the plate's shorter edge");
      return plate_mesh({size, table.real("hole_radius"), segments_of(table, 4)});
    }
    case MeshKind::pipe:
      check_smaller(table, "inner_radius", "radius");
      return pipe_mesh({table.real("inner_radius"), radius(), length(), segments_of(table)});
    case MeshKind::drum:
      return drum_of(table);
    case MeshKind::screw:
      return screw_of(table);
    case MeshKind::rectangle: {
      const Vec3 size = size_of(table, 2);
      return rectangle_mesh(size.x, size.y);
    }
    case MeshKind::line:
      break;
  }
  return line_of(table, space);
}

bool is_sheet(const DeckTable& table) {
  switch (table.choice<MeshKind>("kind")) {
    case MeshKind::file:
      return table.boolean("sheet");
    case MeshKind::line:
      return !table.boolean("closed");
    case MeshKind::rectangle:
      return true;
    default:
      return false;
  }
}

// Into the frame of what carries it.
void place(const DeckTable& table, TriangleMesh& mesh) {
  const Quaternion turn = read_orientation(table);
  const Mat3 axes = rotation_matrix(turn);
  const Vec3 offset = table.vector("offset");
  const Real scale = table.has("scale") ? table.real("scale") : 1;
  for (Vec3& vertex : mesh.vertices) {
    vertex = scale * vertex;
    vertex = (turn.w == 1 ? vertex : axes * vertex) + offset;
  }
}

// The key that troubles are about: a file's or the kind's.
std::string key_of(const DeckTable& table) { return table.has("file") ? "file" : "kind"; }

void check(const DeckTable& table, const TriangleMesh& mesh, const std::vector<Index>& numbers, bool sheet) {
  std::string troubles;
  for (const std::string& trouble : mesh_troubles(mesh, sheet, numbers)) troubles += "\n  " + trouble;
  if (!troubles.empty()) table.fail(key_of(table), "the mesh is no surface:" + troubles);
}

TriangleMesh sound_mesh(const DeckTable& table, const Space& space) {
  try {
    TriangleMesh mesh = made(table, space);
    place(table, mesh);
    LooselyWelded joined{welded(mesh), {}};
    if (table.has("weld")) joined = welded_within(mesh, table.real("weld"));
    check(table, joined.mesh, joined.numbers, is_sheet(table));
    return joined.mesh;
  } catch (const InputError& error) {
    const std::string text = error.what();
    if (text.rfind(table.place(), 0) == 0) throw;
    table.fail(key_of(table), text);
  }
}

}  // namespace

void build_meshes(const DeckTable& deck, Model& model, ModelNames& names) {
  const bool planar = deck.table("space").integer("dimension") == 2;
  Space space;
  space.min = deck.table("space").vector("min"), space.max = deck.table("space").vector("max");
  for (const DeckTable& table : deck.tables("meshes")) {
    if (planar != (table.choice<MeshKind>("kind") == MeshKind::line))
      table.fail("kind",
                 planar ? "must be \"line\", as space.dimension = 2" : "\"line\" needs space.dimension = 2");
    add_name(names.meshes, table.text("name"), static_cast<int>(model.meshes.size()), table);
    const TriangleMesh mesh = sound_mesh(table, space);
    model.meshes.push_back({table.text("name"), std::make_shared<const SurfaceMesh>(build_surface_mesh(
                                                    mesh, table.real("feature_angle"), is_sheet(table)))});
    names.triangles.push_back(mesh);
  }
}

}  // namespace scree
