// Neighbour lists of particles and surfaces for one rank.
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
#include "mesh/cached_contact.hpp"
#include "partition/cell_grid.hpp"

namespace scree {

// Row i has every surface that can touch particle i before the list expires, by number and image; a mesh once
// for every contact that is possible or in the history.
struct SurfaceRows {
  std::vector<Index> offsets;       // [particles + 1]
  std::vector<Index> surfaces;      // [entries]
  std::vector<std::int8_t> images;  // [entries]
  std::vector<Index> particles;     // [entries]
  std::vector<Index> by_surface;    // [entries with placed surfaces], surface by surface
  std::vector<MeshGroup> groups;
  std::vector<Index> triangles;  // of the groups
  // Per group, from previous queries; the rows do not depend on it.
  std::vector<CachedContact> cached_contacts;

  SurfaceEntries entries() const {
    return {surfaces.data(), images.data(), particles.data(), by_surface.data()};
  }
  // Whether two entries of a row belong to the same group.
  bool alike(Index a, Index b) const { return surfaces[a] == surfaces[b] && images[a] == images[b]; }
};

struct LevelCells;

// Particles sorted by level and cell.
struct SortedParticles {
  const LevelCells& cells;         // of particles, and of ghosts, which are numbered from `active` on
  std::span<const Vec4> position;  // x, y, z, radius
  Index active;                    // particles in the search
};

// Box with the centres of all particles of at most `radius` that come within `skin` of the mesh of the placed
// surface s, shifted by `shift` [m]. It is infinite along periods that the mesh spans.
Box box_near(const SurfacePoses& poses, Index s, Vec3 shift, Real radius, Real skin);

// Number of contacts of a particle with a surface in the history; empty: no history.
using StoredContactCount = std::function<Index(Index particle, Index surface)>;

// Input of the search.
struct SurfaceSearch {
  const SurfaceSet& surfaces;
  std::span<const WallPlane> planes;
  SurfacePoses poses;
  Vec3 period;  // [m]
  Real skin;    // search distance beyond touch [m]
  StoredContactCount stored_contacts{};
  // Whether a particle may touch a placed surface; empty: it may touch all.
  std::function<bool(Index particle, Index placed)> may_touch{};
};

// A particle at p (x, y, z, radius) and the mesh of the placed surface s, for the search within skin.
MeshQuery mesh_query(const SurfacePoses& poses, Index s, Vec4 p, Vec3 shift, Real skin);

// owned: particles with a row, of which the first `active` are in the search.
void build_rows(const SortedParticles& sorted, Index owned, const SurfaceSearch& search, SurfaceRows& rows);

}  // namespace scree
