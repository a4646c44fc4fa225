// Walls inside the domain, and their motions.
#include <fmt/format.h>

#include <cmath>

#include "model/builder/build_parts.hpp"
#include "model/derived/time_functions.hpp"

namespace scree {

namespace {

// Normalizes a vector that may have any length but 0 in the deck.
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

// Throws InputError for a plane that is not parallel to a periodic axis: it would not continue across the
// periodic side, and a particle that crosses the side would be behind it or away from it at once.
void check_periodic_axes(const DeckTable& table, const Wall& wall, const Space& space) {
  constexpr Real kRoundOff = 1e-12;
  for (int k = 0; k < space.dimension; ++k) {
    if (space.boundary[static_cast<std::size_t>(2 * k)] != Boundary::periodic) continue;
    const char name = "xyz"[k];
    const Vec3 periodic{k == 0 ? Real(1) : Real(0), k == 1 ? Real(1) : Real(0), k == 2 ? Real(1) : Real(0)};
    if (std::abs(dot(wall.normal, periodic)) > kRoundOff)
      table.fail("normal", fmt::format("has a part along {}, which is periodic: a plane must be parallel to "
                                       "periodic axes; a mesh may stand across them",
                                       name));
    const std::vector<DeckTable> motions = table.tables("motions");
    for (std::size_t m = 0; m < motions.size(); ++m) {
      const WallMotion& motion = wall.motions[m];
      const auto along_axis = [&](Vec3 way) { return norm(cross(motion.axis, way)) <= kRoundOff; };
      if (motion.kind == WallMotionKind::rotation && !along_axis(periodic) && !along_axis(wall.normal))
        motions[m].fail(
            "type", fmt::format("turns the plane across {}, which is periodic; a mesh may turn so", name));
    }
  }
}

// Throws InputError where the surface velocity of a plane has a normal component, which would have no effect.
void check_runs_along(const DeckTable& table, const Wall& wall) {
  constexpr Real kRoundOff = 1e-9;
  const Vec3 v = wall.surface_velocity;
  const Real across = dot(v, wall.normal);
  if (std::abs(across) <= kRoundOff * norm(v)) return;
  table.fail(
      "surface_velocity",
      fmt::format("has a part of {:.4g} m/s along the plane's normal; a surface runs along itself, and "
                  "motions move a wall",
                  across));
}

}  // namespace

Wall build_wall(const DeckTable& table, const ModelNames& names, const Space& space) {
  Wall wall{table.text("name"), {}, {}, find_material(names, table, "material")};
  for (const DeckTable& motion : table.tables("motions"))
    wall.motions.push_back(build_wall_motion(motion, space.dimension));
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
  check_periodic_axes(table, wall, space);
  check_runs_along(table, wall);
  return wall;
}

}  // namespace scree
