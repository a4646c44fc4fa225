// The cell grid in the order of a GPU's caches.
#pragma once

#include "partition/cell_grid.hpp"

namespace scree {

// Cells are numbered brick by brick, so that the particles of a thread block and most of their neighbours share
// cache lines: 4 x 4 x 4 cells in 3D, 8 x 8 in 2D.
struct BrickGrid {
  CellGrid cells;
  Index side[3] = {4, 4, 4};
  Index bricks[3] = {1, 1, 1};

  Index count() const { return bricks[0] * bricks[1] * bricks[2] * side[0] * side[1] * side[2]; }
  SCREE_HD Index key(Index x, Index y, Index z) const {
    const Index brick = (z / side[2] * bricks[1] + y / side[1]) * bricks[0] + x / side[0];
    return ((brick * side[2] + z % side[2]) * side[1] + y % side[1]) * side[0] + x % side[0];
  }
};

inline BrickGrid make_brick_grid(const CellGrid& cells) {
  BrickGrid grid;
  grid.cells = cells;
  if (cells.layer) grid.side[0] = grid.side[1] = 8, grid.side[2] = 1;
  for (int axis = 0; axis < 3; ++axis) grid.bricks[axis] = (cells.cells[axis] + grid.side[axis] - 1) / grid.side[axis];
  return grid;
}

}  // namespace scree
