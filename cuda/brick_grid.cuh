// The cell grid in the order of a GPU's caches.
#pragma once

#include <algorithm>

#include "dem/neighbor_list.hpp"

namespace scree {

// Cells are numbered brick by brick, so that the particles of a thread block and most of their neighbours share
// cache lines: 4 x 4 x 4 cells in 3D, 8 x 8 in 2D. Bricks are numbered along the axis with the fewest of them first, so
// that those beside each other are as close in memory as can be.
struct BrickGrid {
  SearchCells cells;
  Index shift[3] = {2, 2, 2};  // sides of a brick as powers of two
  Index stride[3] = {1, 1, 1};  // from a brick to the next along an axis
  Index bricks = 1;

  Index count() const { return bricks << (shift[0] + shift[1] + shift[2]); }
  SCREE_HD Index key(Index x, Index y, Index z) const {
    const Index brick = (z >> shift[2]) * stride[2] + (y >> shift[1]) * stride[1] + (x >> shift[0]) * stride[0];
    const auto inside = [this](Index along, int axis) { return along & ((1 << shift[axis]) - 1); };
    return (((brick << shift[2] | inside(z, 2)) << shift[1] | inside(y, 1)) << shift[0]) | inside(x, 0);
  }
  // The first cell of the brick after that of x.
  SCREE_HD Index next_brick(Index x) const { return ((x >> shift[0]) + 1) << shift[0]; }
};

inline BrickGrid make_brick_grid(const SearchCells& cells) {
  BrickGrid grid;
  grid.cells = cells;
  if (cells.own.layer) grid.shift[0] = grid.shift[1] = 3, grid.shift[2] = 0;
  Index bricks[3];
  for (int axis = 0; axis < 3; ++axis) bricks[axis] = ((cells.own.cells[axis] - 1) >> grid.shift[axis]) + 1;
  int order[3] = {0, 1, 2};
  std::stable_sort(order, order + 3, [&](int a, int b) { return bricks[a] < bricks[b]; });
  for (const int axis : order) grid.stride[axis] = grid.bricks, grid.bricks *= bricks[axis];
  return grid;
}

}  // namespace scree
