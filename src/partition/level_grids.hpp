// Grids of cells for items of many sizes: one grid per level of radii, all in one space of cell indices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/box.hpp"
#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "partition/cell_grid.hpp"
#include "partition/decomposition.hpp"

namespace scree {

// Levels of radii, each about a factor of two wide; one for radii that differ by less than 2 sqrt(2). The
// rows of a list do not depend on them.
struct SizeLevels {
  static constexpr int kMost = 24;
  int count = 1;
  Real radius[kMost] = {};  // largest of each level, in ascending order [m]

  SizeLevels() = default;
  // smallest, largest: radius of the particles of all ranks; 0 without particles [m].
  SizeLevels(Real smallest, Real largest);

  int top() const { return count - 1; }
  Real largest() const { return radius[count - 1]; }
  // Level of an item of this radius. Radii beyond the range belong to the lowest or to the top level.
  SCREE_HD int of(Real item_radius) const {
    int level = 0;
    while (level < count - 1 && item_radius > radius[level]) ++level;
    return level;
  }
};

// Distance from the box of a rank within which an item is a partner of items of its level or a lower one in
// the box [m]. past_touch: search distance beyond touch [m].
inline Real reach_in_level(const SizeLevels& levels, Real radius, Real past_touch) {
  return (radius + levels.radius[levels.of(radius)] + past_touch) * (1 + kBoxRoundOff);
}

// The grid of a level. Its cells are numbered from first_cell on.
struct LevelGrid {
  CellGrid grid;
  Index first_cell = 0;
  Index items = 0;  // of this rank in the level
  Real radius = 0;  // largest of the level [m]

  Index nearest(Vec3 p) const { return first_cell + grid.nearest(p); }
  // The cells with all items that come within past_touch of touching an item at p (x, y, z, radius).
  SCREE_HD CellRange near(Vec4 p, Real past_touch) const {
    return cells_near(grid, xyz(p), (p.w + radius + past_touch) * (1 + kBoxRoundOff));
  }
};

// Extent and cells of the grids.
struct LevelSpace {
  Box extent;  // [m]
  int dimension = 3;
  Real past_touch = 0;  // search distance beyond touch [m]
};

// The part of a box that is inside the domain: sides of the domain that are not periodic are at infinity.
Box finite_part(const Box& box, const Box& domain);

// A grid for each level, with cells at least as wide as its largest diameter plus the search distance, and as
// many cells as suit its number of items.
std::vector<LevelGrid> make_level_grids(const SizeLevels& levels, const LevelSpace& space,
                                        std::span<const Index> items);

// Upper bound of the number of cells for this many items, representable as Index.
Index most_cells(std::int64_t items);

// Items sorted by level and cell.
struct LevelCells {
  std::vector<LevelGrid> levels;
  std::vector<Index> start, items;  // [cells + 1] into items, [sorted]

  // cell_of: cell of each item among those of all levels; negative: the item is in none.
  void sort(std::span<const Index> cell_of);
  // Calls visit(first, last) for the runs [first, last) of items in a range of cells of a level.
  template <class Visit>
  void for_each_run(const LevelGrid& level, const CellRange& range, const Visit& visit) const {
    for (Index z = range.lower.z; z <= range.upper.z; ++z)
      for (Index y = range.lower.y; y <= range.upper.y; ++y)
        visit(start[level.first_cell + level.grid.index(range.lower.x, y, z)],
              start[level.first_cell + level.grid.index(range.upper.x, y, z) + 1]);
  }
};

}  // namespace scree
