// Levels of radii cover their range without a narrow one; their grids share one space of indices.
#include "partition/level_grids.hpp"

#include <vector>

#include "support/catch.hpp"

namespace scree {

TEST_CASE("radii that differ by less than 2 sqrt(2) are one level") {
  for (const Real ratio : {1.0, 1.5, 2.0, 2.8}) {
    const SizeLevels levels(0.1, ratio * 0.1);
    CHECK(levels.count == 1);
    CHECK(levels.largest() == ratio * 0.1);
  }
  CHECK(SizeLevels(0, 0).count == 1);  // no particles
  CHECK(SizeLevels().count == 1);
}

TEST_CASE("levels are a factor of two wide, the top one 1.4 to 2.83") {
  for (const Real ratio : {2.9, 3.0, 4.0, 6.0, 10.0, 100.0, 12345.0}) {
    CAPTURE(ratio);
    const Real smallest = 1e-4;
    const SizeLevels levels(smallest, ratio * smallest);
    REQUIRE(levels.count > 1);
    CHECK(levels.largest() == ratio * smallest);
    Real below = smallest;
    for (int k = 0; k < levels.count; ++k) {
      const Real width = levels.radius[k] / below;
      CHECK((k < levels.top() ? width == 2 : width > 1.41 && width < 2.84));
      CHECK(levels.of(levels.radius[k]) == k);
      CHECK(levels.of(below * 1.001) == k);
      below = levels.radius[k];
    }
    CHECK(levels.of(smallest / 2) == 0);
    CHECK(levels.of(levels.largest() * 2) == levels.top());
  }
}

TEST_CASE("the number of levels is limited, and the top one has all larger radii") {
  const SizeLevels levels(1e-12, 1e12);
  CHECK(levels.count == SizeLevels::kMost);
  CHECK(levels.largest() == 1e12);
}

TEST_CASE("items are in the runs of their level's cells, each once") {
  const SizeLevels levels(0.01, 0.05);
  REQUIRE(levels.count == 2);
  const LevelSpace space{{{0, 0, 0}, {1, 1, 1}}, 3, 0.005};
  const std::vector<Index> counts{3, 1};
  LevelCells cells;
  cells.levels = make_level_grids(levels, space, counts);
  CHECK(cells.levels[0].first_cell == 0);
  CHECK(cells.levels[1].first_cell == cells.levels[0].grid.count());
  CHECK(1 / cells.levels[1].grid.inverse_size.x >= 0.105);
  const Vec3 at[] = {{0.5, 0.5, 0.5}, {0.51, 0.5, 0.5}, {0.9, 0.1, 0.1}, {0.5, 0.52, 0.5}};
  const int level_of[] = {0, 0, 0, 1};
  std::vector<Index> cell_of;
  for (int i = 0; i < 4; ++i)
    cell_of.push_back(cells.levels[static_cast<std::size_t>(level_of[i])].nearest(at[i]));
  cell_of.push_back(-1);
  cells.sort(cell_of);
  CHECK(cells.items.size() == 4);
  const auto near = [&](int level, Vec3 p, Real range) {
    std::vector<Index> found;
    const LevelGrid& of = cells.levels[static_cast<std::size_t>(level)];
    cells.for_each_run(of, cells_near(of.grid, p, range), [&](Index first, Index last) {
      for (Index k = first; k < last; ++k) found.push_back(cells.items[static_cast<std::size_t>(k)]);
    });
    return found;
  };
  CHECK(near(0, {0.505, 0.5, 0.5}, 0.03) == std::vector<Index>{0, 1});
  CHECK(near(0, {0.9, 0.1, 0.1}, 0) == std::vector<Index>{2});
  CHECK(near(1, {0.5, 0.5, 0.5}, 0.1) == std::vector<Index>{3});
  CHECK(near(0, {0.5, 0.5, 0.5}, 2).size() == 3);
}

}  // namespace scree
