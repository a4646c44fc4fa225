// Uniform grid of cells over the domain, one layer thick in 2D.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/box.hpp"
#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

struct CellIndex {
  Index x, y, z;
};

// Cells are numbered with x fastest, so that three neighbours in x are contiguous.
struct CellGrid {
  Vec3 origin;        // lower corner of cell (0, 0, 0) [m]
  Vec3 inverse_size;  // 1 / edge length per axis [1/m]
  Index cells[3] = {1, 1, 1};
  bool layer = false;  // 2D: a single layer of cells

  Index count() const { return cells[0] * cells[1] * cells[2]; }
  SCREE_HD Index index(Index x, Index y, Index z) const { return (z * cells[1] + y) * cells[0] + x; }
  // Coordinates of the cell of a point; x is -1 for points outside the grid.
  SCREE_HD CellIndex cell_index(Vec3 p) const {
    const Real fx = std::floor((p.x - origin.x) * inverse_size.x);
    const Real fy = std::floor((p.y - origin.y) * inverse_size.y);
    const Real fz = layer ? 0 : std::floor((p.z - origin.z) * inverse_size.z);
    const bool inside = fx >= 0 && fx < cells[0] && fy >= 0 && fy < cells[1] && fz >= 0 && fz < cells[2];
    if (!inside) return {-1, -1, -1};
    return {static_cast<Index>(fx), static_cast<Index>(fy), static_cast<Index>(fz)};
  }
  // Number of the cell of a point, or -1 outside the grid.
  SCREE_HD Index cell(Vec3 p) const {
    const CellIndex c = cell_index(p);
    return c.x < 0 ? -1 : index(c.x, c.y, c.z);
  }
  // Coordinates of the cell of a point or, outside the grid, of the nearest cell: points within a cell width
  // of each other are in neighbouring cells.
  SCREE_HD CellIndex nearest_cell(Vec3 p) const {
    const auto along = [](Real at, Index count) {
      at = std::floor(at);
      return !(at > 0) ? Index(0) : at < count ? static_cast<Index>(at) : count - 1;
    };
    return {along((p.x - origin.x) * inverse_size.x, cells[0]),
            along((p.y - origin.y) * inverse_size.y, cells[1]),
            layer ? 0 : along((p.z - origin.z) * inverse_size.z, cells[2])};
  }
  Index nearest(Vec3 p) const {
    const CellIndex c = nearest_cell(p);
    return index(c.x, c.y, c.z);
  }
};

// A range of cells; upper is included.
struct CellRange {
  CellIndex lower, upper;
};
// The cells with all points that are within `range` of p along each axis.
SCREE_HD CellRange cells_near(const CellGrid& grid, Vec3 p, Real range) {
  return {grid.nearest_cell(p - Vec3{range, range, range}), grid.nearest_cell(p + Vec3{range, range, range})};
}
// The cells of a box.
inline CellRange cells_near(const CellGrid& grid, const Box& box) {
  return {grid.nearest_cell(box.min), grid.nearest_cell(box.max)};
}

// A grid over [min, max] with a margin of one cell on every side for halo copies and body shapes. Cells are
// at least min_cell wide [m] and at most max_cells in number: a large, sparsely filled domain gets larger
// cells.
inline CellGrid make_cell_grid(Vec3 min, Vec3 max, int dimension, Real min_cell, Index max_cells) {
  const Vec3 extent = max - min;
  const auto cells_along = [](Real length, Real size) { return std::max(1.0, std::floor(length / size)); };
  const Real longest = std::max({extent.x, extent.y, extent.z});
  Real size = min_cell > 0 ? min_cell : longest;  // without any size, one cell for all
  const auto total = [&] {
    return (cells_along(extent.x, size) + 2) * (cells_along(extent.y, size) + 2) *
           (dimension == 3 ? cells_along(extent.z, size) + 2 : 1);
  };
  while (total() > max_cells && cells_along(longest, size) > 1) size *= 1.25;
  CellGrid grid;
  grid.layer = dimension == 2;
  const auto axis = [&](Real start, Real length, Real& origin, Real& inverse, Index& cells) {
    const Real n = cells_along(length, size);
    const Real edge = std::max(length / n, size);
    origin = start - edge;
    inverse = 1 / edge;
    cells = static_cast<Index>(n) + 2;
  };
  axis(min.x, extent.x, grid.origin.x, grid.inverse_size.x, grid.cells[0]);
  axis(min.y, extent.y, grid.origin.y, grid.inverse_size.y, grid.cells[1]);
  if (dimension == 3) axis(min.z, extent.z, grid.origin.z, grid.inverse_size.z, grid.cells[2]);
  return grid;
}

}  // namespace scree
