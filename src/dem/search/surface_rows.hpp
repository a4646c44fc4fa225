// Which surfaces each particle of a rank is near: for surfaces what the neighbour list is for particles.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/box.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/contact/contact_walk.hpp"
#include "dem/surfaces/mesh_rows.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "mesh/standing.hpp"
#include "partition/cell_grid.hpp"

namespace scree {

// Row i has every surface that can touch particle i before the list expires, by number and image; a mesh as
// often as the particle may have contacts with it, or remembers them.
struct SurfaceRows {
  std::vector<Index> offsets;       // [particles + 1]
  std::vector<Index> surfaces;      // [entries]
  std::vector<std::int8_t> images;  // [entries]
  std::vector<Index> particles;     // [entries]
  std::vector<Index> by_surface;    // [entries with placed surfaces], surface by surface
  std::vector<MeshGroup> groups;
  std::vector<Index> triangles;     // of the groups
  std::vector<Standing> standings;  // per group: of those who looked at it; the rows do not depend on it

  SurfaceEntries entries() const {
    return {surfaces.data(), images.data(), particles.data(), by_surface.data()};
  }
  // Whether two entries of a row are of the same group.
  bool alike(Index a, Index b) const { return surfaces[a] == surfaces[b] && images[a] == images[b]; }
};

// Particles in the order of their cells.
struct SortedParticles {
  const CellGrid& grid;
  const std::vector<Index>& start;  // [cells + 1] into items
  const std::vector<Index>& items;  // particles, and ghosts, which count from `active` on
  std::span<const Vec4> position;   // x, y, z, radius
  Index active;                     // particles in the search
  Real largest_radius;              // of one [m]
};

// The cells that particles can be in which touch a sphere at p within the reach: lower, and upper one
// included.
struct CellRange {
  CellPlace lower, upper;
};
SCREE_HD CellRange cells_near(const CellGrid& grid, Vec3 p, Real reach) {
  return {grid.nearest_place(p - Vec3{reach, reach, reach}),
          grid.nearest_place(p + Vec3{reach, reach, reach})};
}
// The same of particles in a box.
inline CellRange cells_near(const CellGrid& grid, const Box& box) {
  return {grid.nearest_place(box.min), grid.nearest_place(box.max)};
}

// In which the centres are of particles no larger than `radius` that come within `skin` of the mesh of the
// placed surface s, moved by the shift [m]. Along periods that the mesh spans it has no ends.
Box box_near(const SurfacePlaces& places, Index s, Vec3 shift, Real radius, Real skin);

// How many contacts with the surface of a number a particle remembers; none: no contact remembers.
using RememberedCount = std::function<Index(Index particle, Index surface)>;

// What a row may hold.
struct SurfaceSearch {
  const SurfaceSet& surfaces;
  std::span<const WallPlane> planes;
  SurfacePlaces places;
  Vec3 period;  // [m]
  Real skin;    // how far past touch surfaces are looked for [m]
  RememberedCount remembered{};
  // Whether a particle may touch a placed surface; none: it may touch all.
  std::function<bool(Index particle, Index placed)> may_touch{};
};

// Of a particle at p (x, y, z, radius) and the mesh of the placed surface s, which is looked for within skin.
MeshSight sight_of(const SurfacePlaces& places, Index s, Vec4 p, Vec3 shift, Real skin);

// owned: particles that have a row, of which the first `active` are in the search.
void build_rows(const SortedParticles& sorted, Index owned, const SurfaceSearch& search, SurfaceRows& rows);

}  // namespace scree
