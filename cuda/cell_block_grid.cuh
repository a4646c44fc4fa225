// The cell grid of the neighbour search, numbered for the caches of a GPU.
#pragma once

#include <algorithm>
#include <utility>

#include "dem/search/neighbor_list.hpp"

namespace scree {

// Cells are numbered block by block, so that the particles of a thread block and most of their neighbours
// share cache lines: cell blocks of 4 x 4 x 4 cells in 3D, 8 x 8 in 2D. The cell blocks are numbered along
// the axis with the fewest of them first, which puts neighbouring ones as close in memory as possible. With
// several ranks the interior comes first: the cell blocks whose particles have no ghost neighbours and are no
// ghosts on another rank.
struct CellBlockGrid {
  SearchCells cells;
  Index shift[3] = {2, 2, 2};   // log2 of the side of a cell block [cells]
  Index stride[3] = {1, 1, 1};  // between neighbouring cell blocks along an axis
  Index cell_blocks = 1;
  // The axes from the smallest stride to the largest, each with the range of the interior's cell blocks on
  // it.
  struct Along {
    int axis;
    Index first, length;
  } along[3] = {};
  Index interior = 0;  // of interior cell blocks

  Index cells_of(Index number_of_blocks) const {
    return number_of_blocks << (shift[0] + shift[1] + shift[2]);
  }
  Index count() const { return cells_of(cell_blocks); }
  SCREE_HD Index number(Index x, Index y, Index z) const {
    const Index plain = z * stride[2] + y * stride[1] + x * stride[0];
    if (cells.same) return plain;
    const auto offset = [&](const Along& a) { return (a.axis == 0 ? x : a.axis == 1 ? y : z) - a.first; };
    const auto clipped = [](Index at, Index length) { return at < 0 ? 0 : at < length ? at : length; };
    const Index u = offset(along[0]), v = offset(along[1]), w = offset(along[2]);
    const bool in_w = w >= 0 && w < along[2].length, in_v = v >= 0 && v < along[1].length;
    // Interior cell blocks that precede this one when all are numbered by their strides alone.
    Index before = clipped(w, along[2].length) * along[1].length * along[0].length;
    if (in_w) before += clipped(v, along[1].length) * along[0].length;
    if (in_w && in_v) before += clipped(u, along[0].length);
    const bool inside = in_w && in_v && u >= 0 && u < along[0].length;
    return inside ? before : interior + plain - before;
  }
  SCREE_HD Index key(Index x, Index y, Index z) const {
    const Index block = number(x >> shift[0], y >> shift[1], z >> shift[2]);
    const auto inside = [this](Index along, int axis) { return along & ((1 << shift[axis]) - 1); };
    return (((block << shift[2] | inside(z, 2)) << shift[1] | inside(y, 1)) << shift[0]) | inside(x, 0);
  }
  // The first cell in x of the cell block after that of x.
  SCREE_HD Index next_block_start(Index x) const { return ((x >> shift[0]) + 1) << shift[0]; }
};

// The first of the cell blocks along an axis that are further from the faces of the rank's box than the range
// of the list, and their number.
inline std::pair<Index, Index> interior_along(const SearchCells& cells, int axis, Index shift,
                                              Index cell_blocks) {
  if (cells.own.layer && axis == 2) return {0, cell_blocks};
  const auto of = [&](Vec3 v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
  const Real edge = 1 / of(cells.own.inverse_size), margin = cells.list_radius + 1e-6 * edge;
  const Real low = of(cells.box.min) + margin, high = of(cells.box.max) - margin;
  // Positions outside the grid belong to its outermost cells.
  const auto begins = [&](Index block) {
    return block == 0 ? -kInfinity : of(cells.own.origin) + edge * (block << shift);
  };
  const auto ends = [&](Index block) { return block + 1 == cell_blocks ? kInfinity : begins(block + 1); };
  Index first = 0, last = cell_blocks;
  while (first < last && begins(first) < low) ++first;
  while (last > first && ends(last - 1) > high) --last;
  return {first, last - first};
}

inline CellBlockGrid make_cell_block_grid(const SearchCells& cells) {
  CellBlockGrid grid;
  grid.cells = cells;
  if (cells.own.layer) grid.shift[0] = grid.shift[1] = 3, grid.shift[2] = 0;
  Index cell_blocks[3];
  for (int axis = 0; axis < 3; ++axis)
    cell_blocks[axis] = ((cells.own.cells[axis] - 1) >> grid.shift[axis]) + 1;
  int order[3] = {0, 1, 2};
  std::stable_sort(order, order + 3, [&](int a, int b) { return cell_blocks[a] < cell_blocks[b]; });
  for (const int axis : order) grid.stride[axis] = grid.cell_blocks, grid.cell_blocks *= cell_blocks[axis];
  if (cells.same) return grid;
  grid.interior = 1;
  for (int k = 0; k < 3; ++k) {
    const auto [first, length] = interior_along(cells, order[k], grid.shift[order[k]], cell_blocks[order[k]]);
    grid.along[k] = {order[k], first, length};
    grid.interior *= length;
  }
  return grid;
}

}  // namespace scree
