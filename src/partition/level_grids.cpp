#include "partition/level_grids.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/countable.hpp"

namespace scree {

// The top level is wider or narrower than the others, so that none has a small part of a factor of two: each
// level costs a search of its cells by all smaller particles.
SizeLevels::SizeLevels(Real smallest, Real largest) {
  constexpr Real kWidest = 2.83;  // 2 sqrt(2)
  count = 0;
  for (Real least = smallest; least > 0 && largest > kWidest * least && count < kMost - 1;)
    radius[count++] = least *= 2;
  radius[count++] = largest;
}

Index most_cells(std::int64_t items) {
  return static_cast<Index>(std::min<std::int64_t>(4 * items + 4096, std::numeric_limits<Index>::max() / 2));
}

Box finite_part(const Box& box, const Box& domain) {
  const auto finite = [](Vec3 corner, Vec3 of_domain) {
    return Vec3{std::isfinite(corner.x) ? corner.x : of_domain.x,
                std::isfinite(corner.y) ? corner.y : of_domain.y,
                std::isfinite(corner.z) ? corner.z : of_domain.z};
  };
  return {finite(box.min, domain.min), finite(box.max, domain.max)};
}

std::vector<LevelGrid> make_level_grids(const SizeLevels& levels, const LevelSpace& space,
                                        std::span<const Index> items) {
  std::vector<LevelGrid> grids;
  std::size_t cells = 0;
  for (int k = 0; k < levels.count; ++k) {
    const Index in_level = items[static_cast<std::size_t>(k)];
    const CellGrid grid = make_cell_grid(space.extent.min, space.extent.max, space.dimension,
                                         2 * levels.radius[k] + space.past_touch, most_cells(in_level));
    grids.push_back({grid, static_cast<Index>(cells), in_level, levels.radius[k]});
    cells += static_cast<std::size_t>(grid.count());
    countable(cells, "stage neighbors: more cells");
  }
  return grids;
}

void LevelCells::sort(std::span<const Index> cell_of) {
  const Index cells = levels.back().first_cell + levels.back().grid.count();
  start.assign(static_cast<std::size_t>(cells) + 1, 0);
  for (const Index cell : cell_of)
    if (cell >= 0) ++start[cell + 1];
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
  items.resize(static_cast<std::size_t>(start.back()));
  std::vector<Index>& next = start;  // shifted by one slot while filling, restored below
  for (std::size_t i = 0; i < cell_of.size(); ++i)
    if (cell_of[i] >= 0) items[next[cell_of[i]]++] = static_cast<Index>(i);
  for (std::size_t c = next.size() - 1; c > 0; --c) next[c] = next[c - 1];
  next[0] = 0;
}

}  // namespace scree
