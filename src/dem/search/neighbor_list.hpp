// Full neighbour list with a skin, rows ordered by the neighbours' global ids.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/search/list_rows.hpp"
#include "model/data/model.hpp"
#include "partition/decomposition.hpp"
#include "partition/level_grids.hpp"

namespace scree {

// Cells as wide as the largest particle's search distance.
struct SearchCells {
  CellGrid space;  // items in one of its cells are searched, for any number of ranks
  CellGrid own;    // cells over the box of this rank; the same with one rank
  bool same = true;
  DomainBox box{};       // of this rank
  Real list_radius = 0;  // of the list beyond the box [m]
  bool finer = false;    // whether the cells of `own` suit the smallest particles instead

  // Cell index in `own`; x is -1 for items that are not searched.
  SCREE_HD CellIndex cell_index(Vec3 p) const {
    const CellIndex c = space.cell_index(p);
    return c.x < 0 || (same && !finer) ? c : own.nearest_cell(p);
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
  Real cutoff(Real skin) const { return 2 * largest_radius() + search_margin(skin); }
  // Search distance beyond touch [m].
  Real search_margin(Real skin) const { return skin + model_.contact.interaction_range; }
  // Largest radius of a particle [m].
  Real largest_radius() const { return levels_.largest(); }
  // Levels of the particles' radii, and the domain for a search up to `margin` beyond touch [m].
  const SizeLevels& levels() const { return levels_; }
  LevelSpace level_space(Real margin) const { return {domain_, model_.space.dimension, margin}; }
  // The cells by which `items` particles of this rank are best ordered in memory: those of the smallest.
  CellGrid finest_cells(const SearchCells& cells, Real skin, Index items) const;
  // The same with these cells as `own`, for several levels.
  SearchCells by_finest_cells(SearchCells cells, Real skin, Index items) const;
  // Grids of all levels for ghosts in the halo, too. in_all: number of this rank's items.
  std::vector<LevelGrid> level_grids(const SearchCells& cells, Real skin, Index in_all) const;
  // Fills the list from the positions of all items and the poses of the placed surfaces.
  void build(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
             const ListedSurfaces& surfaces, Real skin, NeighborList& list);
  // Fills the rows of surfaces only.
  void build_surfaces(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                      const ListedSurfaces& surfaces, Real skin, SurfaceRows& rows);

 private:
  // Pairs of items in two levels.
  struct LevelPairs {
    std::vector<Index> above_start, above;  // [items + 1]: the partners in higher levels
    std::vector<Index> below_start, below;  // [owned + 1]: the partners in lower levels
  };
  // A grid over the domain, or over a box within it.
  CellGrid cells_of(const Box& extent, Real width, std::int64_t items) const;
  void sort(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells, Real skin);
  void sort_by_level(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                     Real skin);
  void find_surfaces(const ParticleStore& store, const ItemLayout& layout, const ListedSurfaces& surfaces,
                     Real skin, SurfaceRows& rows) const;
  void find_above(const ParticleStore& store, const ItemLayout& layout, Real margin);
  void find_below(const ItemLayout& layout);
  // Adds the neighbours of item i.
  void collect_row(const ParticleStore& store, Index i, NeighborList& list) const;

  const Model& model_;
  Box domain_;
  Subdomain subdomain_;
  SurfaceSet surfaces_;
  std::vector<WallPlane> planes_;
  SizeLevels levels_;
  LevelCells near_;
  std::vector<Index> cell_of_;  // [all items]; negative for those in no cell
  LevelPairs pairs_;            // with several levels
};

}  // namespace scree
