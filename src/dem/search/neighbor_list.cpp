#include "dem/search/neighbor_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "base/countable.hpp"

namespace scree {
namespace {

// Cells of items that are in none: not searched, or searched in the cells of higher levels only.
constexpr Index kNotSearched = -1, kInNoCell = -2;

bool is_searched(const ItemLayout& layout, Index i) { return i < layout.active || i >= layout.owned; }

// Appends the items in a range of cells that come within `margin` of touching item i.
void append_near(const ParticleStore& store, Index i, const LevelCells& cells, const LevelGrid& level,
                 const CellRange& range, Real margin, std::vector<Index>& to) {
  const Vec4 p = store.position[i];
  std::size_t count = to.size();
  cells.for_each_run(level, range, [&](Index first, Index last) {
    to.resize(count + static_cast<std::size_t>(last - first));
    Index* const entries = to.data();
    for (Index k = first; k < last; ++k) {
      const Index j = cells.items[k];
      const Vec4& q = store.position[j];  // a copy would go through memory
      const Vec3 d{p.x - q.x, p.y - q.y, p.z - q.z};
      const Real distance = p.w + q.w + margin;
      entries[count] = j;  // kept or overwritten: a branch would be mispredicted often
      count += static_cast<std::size_t>((dot(d, d) < distance * distance) & (j != i));
    }
  });
  to.resize(count);
}

CellRange cells_around(const CellGrid& grid, Index cell) {
  const Index x = cell % grid.cells[0], y = cell / grid.cells[0] % grid.cells[1],
              z = cell / (grid.cells[0] * grid.cells[1]);
  return {{std::max(x - 1, 0), std::max(y - 1, 0), std::max(z - 1, 0)},
          {std::min(x + 1, grid.cells[0] - 1), std::min(y + 1, grid.cells[1] - 1),
           std::min(z + 1, grid.cells[2] - 1)}};
}

}  // namespace

NeighborBuilder::NeighborBuilder(const Model& model)
    : model_(model),
      domain_{model.space.min, model.space.max},
      subdomain_(model.space),
      surfaces_(model),
      planes_(wall_planes(model)),
      levels_(model.particles.totals.smallest_radius, model.particles.totals.largest_radius) {}

CellGrid NeighborBuilder::cells_of(const Box& extent, Real width, std::int64_t items) const {
  return make_cell_grid(extent.min, extent.max, model_.space.dimension, width, most_cells(items));
}

CellGrid NeighborBuilder::grid(Real skin, Index items) const {
  return cells_of(domain_, cutoff(skin), items);
}

SearchCells NeighborBuilder::cells(Real skin, std::int64_t particles) const {
  const CellGrid space = cells_of(domain_, cutoff(skin), particles);
  return {space, space, true, subdomain_.periodic_box()};
}

SearchCells NeighborBuilder::cells(Real skin, std::int64_t particles, const DomainBox& box,
                                   Index items) const {
  SearchCells out = cells(skin, particles);
  out.own = cells_of(finite_part(box, domain_), cutoff(skin), items);
  out.same = false;
  out.box = box, out.list_radius = cutoff(skin) * (1 + kBoxRoundOff);
  return out;
}

CellGrid NeighborBuilder::finest_cells(const SearchCells& cells, Real skin, Index items) const {
  if (levels_.count == 1) return cells.own;
  return cells_of(finite_part(cells.box, domain_), 2 * levels_.radius[0] + search_margin(skin), items);
}

SearchCells NeighborBuilder::by_finest_cells(SearchCells cells, Real skin, Index items) const {
  if (levels_.count == 1) return cells;
  cells.own = finest_cells(cells, skin, items), cells.finer = true;
  return cells;
}

std::vector<LevelGrid> NeighborBuilder::level_grids(const SearchCells& cells, Real skin, Index in_all) const {
  LevelSpace space = level_space(search_margin(skin));
  space.extent = finite_part(cells.box, domain_);
  const Real width = cutoff(skin), layer = model_.space.dimension == 3 ? width : 0;
  space.extent.min = space.extent.min - Vec3{width, width, layer};
  space.extent.max = space.extent.max + Vec3{width, width, layer};
  // If all levels have equal masses, at least half of the items of a level and of those above are in the
  // level.
  std::vector<Index> items;
  for (int k = 0; k < levels_.count; ++k) items.push_back(in_all >> std::min(k, 30));
  return make_level_grids(levels_, space, items);
}

// With several levels an item searches the cells that its radius reaches, which are fewer than those around.
void NeighborBuilder::collect_row(const ParticleStore& store, Index i, NeighborList& list) const {
  if (cell_of_[i] < 0) return;
  const Real margin = search_margin(list.skin);
  if (levels_.count == 1)
    return append_near(store, i, near_, near_.levels[0], cells_around(near_.levels[0].grid, cell_of_[i]),
                       margin, list.neighbors);
  const LevelGrid& level = near_.levels[levels_.of(store.position[i].w)];
  append_near(store, i, near_, level, level.near(store.position[i], margin), margin, list.neighbors);
  const auto append = [&](const std::vector<Index>& from, const std::vector<Index>& start) {
    list.neighbors.insert(list.neighbors.end(), from.begin() + start[i], from.begin() + start[i + 1]);
  };
  append(pairs_.above, pairs_.above_start), append(pairs_.below, pairs_.below_start);
}

// Every item finds its partners in higher levels, where few cells contain few items. Ghosts search too: the
// rows of owned items contain smaller ghosts.
void NeighborBuilder::find_above(const ParticleStore& store, const ItemLayout& layout, Real margin) {
  std::vector<Index>& above = pairs_.above;
  above.clear(), pairs_.above_start.assign(1, 0);
  for (Index i = 0; i < layout.items; ++i) {
    const auto first = static_cast<std::ptrdiff_t>(above.size());
    const Vec4 p = store.position[i];
    if (cell_of_[i] != kNotSearched)
      for (int k = levels_.of(p.w) + 1; k < levels_.count; ++k)
        if (const LevelGrid& level = near_.levels[k]; level.items > 0)
          append_near(store, i, near_, level, level.near(p, margin), margin, above);
    if (i >= layout.owned)  // pairs of ghosts are in no row
      above.erase(
          std::remove_if(above.begin() + first, above.end(), [&](Index j) { return j >= layout.owned; }),
          above.end());
    pairs_.above_start.push_back(countable(above.size(), "stage neighbors: more neighbours"));
  }
}

// The same pairs for the partners in the higher levels.
void NeighborBuilder::find_below(const ItemLayout& layout) {
  std::vector<Index>& next = pairs_.below_start;  // next free entry of row j at [j + 1] while filling
  next.assign(static_cast<std::size_t>(layout.owned) + 2, 0);
  for (const Index j : pairs_.above)
    if (j < layout.owned) ++next[j + 2];
  std::partial_sum(next.begin(), next.end(), next.begin());
  pairs_.below.resize(static_cast<std::size_t>(next.back()));
  for (Index i = 0; i < layout.items; ++i)
    for (Index k = pairs_.above_start[i]; k < pairs_.above_start[i + 1]; ++k)
      if (const Index j = pairs_.above[k]; j < layout.owned) pairs_.below[next[j + 1]++] = i;
}

void NeighborBuilder::build(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                            const ListedSurfaces& surfaces, Real skin, NeighborList& list) {
  list.skin = skin;
  list.neighbors.clear();
  list.offsets.assign(static_cast<std::size_t>(layout.owned) + 1, 0);
  sort(store, layout, cells, skin);
  if (levels_.count > 1) find_above(store, layout, search_margin(skin)), find_below(layout);
  for (Index i = 0; i < layout.owned; ++i) {
    const Index begin = static_cast<Index>(list.neighbors.size());
    if (i < layout.active) collect_row(store, i, list);
    std::sort(list.neighbors.begin() + begin, list.neighbors.end(),
              [&](Index a, Index b) { return store.row_key[a] < store.row_key[b]; });
    list.offsets[i + 1] = countable(list.neighbors.size(), "stage neighbors: more neighbours");
  }
  find_surfaces(store, layout, surfaces, skin, list.surfaces);
}

void NeighborBuilder::build_surfaces(const ParticleStore& store, const ItemLayout& layout,
                                     const SearchCells& cells, const ListedSurfaces& surfaces, Real skin,
                                     SurfaceRows& rows) {
  sort(store, layout, cells, skin);
  find_surfaces(store, layout, surfaces, skin, rows);
}

void NeighborBuilder::sort(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                           Real skin) {
  cell_of_.resize(static_cast<std::size_t>(layout.items));
  if (levels_.count > 1) return sort_by_level(store, layout, cells, skin);
  near_.levels = {{cells.own, 0, layout.items, largest_radius()}};
  for (Index i = 0; i < layout.items; ++i)
    cell_of_[i] = is_searched(layout, i) ? cells.cell(xyz(store.position[i])) : kNotSearched;
  near_.sort(cell_of_);
}

// A ghost is in the cells of its level only if an owned item of this level or a lower one can touch it. The
// others are in the halo as partners of larger items, and would crowd the cells at the border.
void NeighborBuilder::sort_by_level(const ParticleStore& store, const ItemLayout& layout,
                                    const SearchCells& cells, Real skin) {
  const Real margin = search_margin(skin);
  std::vector<Index> in_level(static_cast<std::size_t>(levels_.count));
  const auto level_of = [&](Index i) { return levels_.of(store.position[i].w); };
  for (Index i = 0; i < layout.items; ++i) {
    const Vec3 p = xyz(store.position[i]);
    const Real reach = reach_in_level(levels_, store.position[i].w, margin);
    const bool searched = is_searched(layout, i) && cells.space.cell(p) >= 0;
    const bool in_cell = searched && (i < layout.owned || cells.box.is_within(p, reach));
    cell_of_[i] = in_cell ? 0 : searched ? kInNoCell : kNotSearched;
    in_level[level_of(i)] += in_cell;
  }
  near_.levels =
      make_level_grids(levels_, {finite_part(cells.box, domain_), model_.space.dimension, margin}, in_level);
  for (Index i = 0; i < layout.items; ++i)
    if (cell_of_[i] == 0) cell_of_[i] = near_.levels[level_of(i)].nearest(xyz(store.position[i]));
  near_.sort(cell_of_);
}

void NeighborBuilder::find_surfaces(const ParticleStore& store, const ItemLayout& layout,
                                    const ListedSurfaces& surfaces, Real skin, SurfaceRows& rows) const {
  build_rows({near_, store.position, layout.active}, layout.owned,
             {surfaces_, planes_, surfaces.poses, subdomain_.period(), search_margin(skin) + surfaces.reach,
              surfaces.stored_contacts},
             rows);
}

}  // namespace scree
