// Full neighbour list with a skin, rows ordered by the neighbours' global ids.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/search/surface_rows.hpp"
#include "model/data/model.hpp"
#include "partition/cell_grid.hpp"
#include "partition/decomposition.hpp"
#include "partition/halo.hpp"

namespace scree {

// Row i holds every item that can touch particle i before the list expires, and the surfaces near it. Rows of
// particles outside the search are empty.
struct NeighborList {
  std::vector<Index> offsets, neighbors;  // [owned + 1], [entries]
  SurfaceRows surfaces;
  Real skin = 0;  // search distance beyond contact [m]
};

// Layout of the items in the store: owned particles, of which the first `active` are in the search, then
// ghosts.
struct ItemLayout {
  Index owned = 0, active = 0, items = 0;
};

// Cells that items are sorted into.
struct SearchCells {
  CellGrid space;  // items in one of its cells are searched, for any number of ranks
  CellGrid own;    // cells over the box of this rank; the same with one rank
  bool same = true;
  DomainBox box{};       // of this rank, unless same
  Real list_radius = 0;  // of the list beyond the box [m]

  // Cell index in `own`; x is -1 for items that are not searched.
  SCREE_HD CellIndex cell_index(Vec3 p) const {
    const CellIndex c = space.cell_index(p);
    return c.x < 0 || same ? c : own.nearest_cell(p);
  }
  Index cell(Vec3 p) const {
    const CellIndex c = cell_index(p);
    return c.x < 0 ? -1 : own.index(c.x, c.y, c.z);
  }
};

// Surfaces for the build of a list.
struct ListedSurfaces {
  SurfacePoses poses;
  StoredContactCount stored_contacts{};
  Real reach = 0;  // search distance in addition to that of the particles [m]
};

class NeighborBuilder {
 public:
  explicit NeighborBuilder(const Model& model);

  // Grid with cells at least one cutoff wide.
  CellGrid grid(Real skin, Index items) const;
  // particles: of all ranks; items: of this rank. They bound the number of cells.
  SearchCells cells(Real skin, std::int64_t particles) const;
  SearchCells cells(Real skin, std::int64_t particles, const DomainBox& box, Index items) const;
  // Largest distance of centres in the list: largest diameter, interaction range and skin [m].
  Real cutoff(Real skin) const { return 2 * largest_radius_ + search_margin(skin); }
  // Search distance beyond touch [m].
  Real search_margin(Real skin) const { return skin + model_.contact.interaction_range; }
  // Largest radius of a particle [m].
  Real largest_radius() const { return largest_radius_; }
  // Fills the list from the positions of all items and the poses of the placed surfaces.
  void build(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
             const ListedSurfaces& surfaces, Real skin, NeighborList& list);
  // Fills the rows of surfaces only.
  void build_surfaces(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                      const ListedSurfaces& surfaces, Real skin, SurfaceRows& rows);

 private:
  // Items sorted by cell.
  struct SortedItems {
    CellGrid grid;
    std::vector<Index> start, items;  // [cells + 1], [searched]
    std::vector<Index> cell_of;       // [all items]; -1 for those that are not searched

    // cell(item): its cell, or -1.
    template <class Cell>
    void sort(const CellGrid& cells, Index count, const Cell& cell);
  };
  void sort(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells);
  void find_surfaces(const ParticleStore& store, const ItemLayout& layout, const ListedSurfaces& surfaces,
                     Real skin, SurfaceRows& rows) const;
  // Adds the neighbours of item i.
  void collect_row(const ParticleStore& store, Index i, NeighborList& list) const;

  const Model& model_;
  Vec3 period_;  // of the domain [m]
  SurfaceSet surfaces_;
  std::vector<WallPlane> planes_;
  Real largest_radius_ = 0;
  SortedItems near_;
};

}  // namespace scree
