// Walls inside the space, and how they move.
#include "model/build_parts.hpp"

namespace scree {

namespace {

// Of any length but 0 in the deck.
Vec3 unit_vector(const DeckTable& table, const std::string& key) {
  const Vec3 a = table.vector(key);
  if (norm(a) == 0) table.fail(key, "must not be 0");
  return (1 / norm(a)) * a;
}

Vec3 rotation_axis(const DeckTable& table, int dimension) {
  if (dimension == 3) {
    if (!table.has("axis")) table.fail("axis", "missing; in 3D it must be given");
    return unit_vector(table, "axis");
  }
  if (table.has("axis")) table.fail("axis", "not used in a space of dimension 2: walls turn about z");
  return {0, 0, 1};
}

WallMotion build_wall_motion(const DeckTable& table, int dimension) {
  if (table.choice<WallMotionKind>("type") == WallMotionKind::translation)
    return {WallMotionKind::translation,
            unit_vector(table, "direction"),
            {},
            build_motion(table.table("displacement"))};
  return {WallMotionKind::rotation, rotation_axis(table, dimension), table.vector("point"),
          build_motion(table.table("angle"))};
}

}  // namespace

Wall build_wall(const DeckTable& table, const ModelNames& names, int dimension) {
  Wall wall{table.text("name"), {}, {}, find_material(names, table, "material")};
  for (const DeckTable& motion : table.tables("motions"))
    wall.motions.push_back(build_wall_motion(motion, dimension));
  if (table.has("surface_velocity")) wall.surface_velocity = table.vector("surface_velocity");
  if (table.has("mesh")) {
    for (const char* key : {"point", "normal"})
      if (table.has(key)) table.fail(key, "not used together with mesh");
    wall.mesh = find_name(names.meshes, table, "mesh", "mesh");
    return wall;
  }
  for (const char* key : {"point", "normal"})
    if (!table.has(key)) table.fail(key, "missing; without mesh it must be given");
  wall.point = table.vector("point"), wall.normal = unit_vector(table, "normal");
  return wall;
}

}  // namespace scree
