// Every point of the domain and its margin has one cell; cells have at least the size asked for.
#include "partition/cell_grid.hpp"

#include "model/derived/random.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

struct GridCase {
  Vec3 min, max;
  int dimension;
  Real min_cell;
  Index max_cells;
};

const GridCase kGrids[] = {{{-3, -3, 0}, {3, 3, 0}, 2, 0.105, 100000},
                           {{0, 0, 0}, {1, 2, 3}, 3, 0.13, 100000},
                           {{-1, -1, 0}, {1, 1, 0}, 2, 5, 100000},
                           {{-1e3, 0, 0}, {1e3, 1, 0}, 2, 0.01, 5000},
                           {{-10, -10, -10}, {10, 10, 10}, 3, 0.01, 20000},
                           {{0.1, 0.1, 0.1}, {0.4, 0.7, 0.2}, 3, 0.1, 100000},
                           {{-0.95, -0.6, 0}, {0.95, 0.3, 0}, 2, 0.3, 100000}};

CellGrid grid_of(const GridCase& c) {
  return make_cell_grid(c.min, c.max, c.dimension, c.min_cell, c.max_cells);
}

Vec3 point_in(RandomNumbers& random, Vec3 min, Vec3 max) {
  const Real x = random.uniform(min.x, max.x), y = random.uniform(min.y, max.y),
             z = random.uniform(min.z, max.z);
  return {x, y, z};
}

}  // namespace

TEST_CASE("every point of the space has a cell, and the cell's box holds the point") {
  RandomNumbers random(1);
  for (const GridCase& c : kGrids) {
    const CellGrid grid = grid_of(c);
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 p = point_in(random, c.min, c.max);
      const Index cell = grid.cell(p);
      REQUIRE((cell >= 0 && cell < grid.count()));
      const Index x = cell % grid.cells[0], y = cell / grid.cells[0] % grid.cells[1];
      const Index z = cell / (grid.cells[0] * grid.cells[1]);
      CHECK(grid.index(x, y, z) == cell);
      const Vec3 in_cells{(p.x - grid.origin.x) * grid.inverse_size.x - x,
                          (p.y - grid.origin.y) * grid.inverse_size.y - y,
                          c.dimension == 3 ? (p.z - grid.origin.z) * grid.inverse_size.z - z : 0};
      for (const Real share : {in_cells.x, in_cells.y, in_cells.z}) CHECK((share >= 0 && share < 1));
    }
  }
}

TEST_CASE("the corners of the space lie inside, with a margin of a cell around them") {
  for (const GridCase& c : kGrids) {
    const CellGrid grid = grid_of(c);
    CHECK(grid.cell(c.min) >= 0);
    CHECK(grid.cell(c.max) >= 0);
    const Vec3 edge{1 / grid.inverse_size.x, 1 / grid.inverse_size.y,
                    c.dimension == 3 ? 1 / grid.inverse_size.z : 0};
    CHECK(grid.cell(c.min - 0.999 * edge) >= 0);
    CHECK(grid.cell(c.max + 0.999 * edge) >= 0);
    CHECK(grid.cell(c.min - Vec3{1.001 * edge.x, 0, 0}) == -1);
    CHECK(grid.cell(c.min - Vec3{0, 1.001 * edge.y, 0}) == -1);
  }
}

TEST_CASE("cells are at least as wide as asked and at most as many") {
  for (const GridCase& c : kGrids) {
    const CellGrid grid = grid_of(c);
    CAPTURE(c.min_cell, c.max_cells);
    CHECK(1 / grid.inverse_size.x >= c.min_cell * (1 - 1e-15));
    CHECK(1 / grid.inverse_size.y >= c.min_cell * (1 - 1e-15));
    if (c.dimension == 3) CHECK(1 / grid.inverse_size.z >= c.min_cell * (1 - 1e-15));
    CHECK(grid.count() <= c.max_cells);
    CHECK(grid.layer == (c.dimension == 2));
    if (c.dimension == 2) CHECK(grid.cells[2] == 1);
  }
}

TEST_CASE("where nothing has a size the space is one cell") {
  for (const int dimension : {2, 3}) {
    const CellGrid grid = make_cell_grid({-1, -1, -1}, {1, 2, 3}, dimension, 0, 100);
    CHECK(grid.cells[0] == 3);
    CHECK(grid.cells[1] == 3);
    CHECK(grid.cells[2] == (dimension == 3 ? 3 : 1));
  }
}

TEST_CASE("points outside the grid and points that are not numbers have no cell") {
  const CellGrid grid = grid_of(kGrids[1]);
  const Real nan = std::nan(""), infinity = INFINITY;
  for (const Vec3 p : {Vec3{nan, 1, 1}, Vec3{0.5, nan, 1}, Vec3{0.5, 1, nan}, Vec3{infinity, 1, 1},
                       Vec3{0.5, -infinity, 1}, Vec3{0.5, 1, 1e300}, Vec3{-5, 1, 1}}) {
    CAPTURE(p.x, p.y, p.z);
    CHECK(grid.cell(p) == -1);
  }
}

}  // namespace scree
