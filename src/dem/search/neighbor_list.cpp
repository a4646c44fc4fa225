#include "dem/search/neighbor_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/countable.hpp"

namespace scree {

NeighborBuilder::NeighborBuilder(const Model& model)
    : model_(model),
      period_(Subdomain(model.space).period()),
      surfaces_(model),
      planes_(wall_planes(model)),
      largest_radius_(model.particles.totals.largest_radius) {}

namespace {

// Upper bound of the number of cells for this many items, representable as Index.
Index most_cells(std::int64_t items) {
  return static_cast<Index>(std::min<std::int64_t>(4 * items + 4096, std::numeric_limits<Index>::max() / 2));
}

}  // namespace

CellGrid NeighborBuilder::grid(Real skin, Index items) const {
  return make_cell_grid(model_.space.min, model_.space.max, model_.space.dimension, cutoff(skin),
                        most_cells(items));
}

SearchCells NeighborBuilder::cells(Real skin, std::int64_t particles) const {
  const CellGrid space = make_cell_grid(model_.space.min, model_.space.max, model_.space.dimension,
                                        cutoff(skin), most_cells(particles));
  return {space, space, true};
}

SearchCells NeighborBuilder::cells(Real skin, std::int64_t particles, const DomainBox& box,
                                   Index items) const {
  SearchCells out = cells(skin, particles);
  const auto finite = [](Vec3 corner, Vec3 of_space) {
    return Vec3{std::isfinite(corner.x) ? corner.x : of_space.x,
                std::isfinite(corner.y) ? corner.y : of_space.y,
                std::isfinite(corner.z) ? corner.z : of_space.z};
  };
  out.own = make_cell_grid(finite(box.min, model_.space.min), finite(box.max, model_.space.max),
                           model_.space.dimension, cutoff(skin), most_cells(items));
  out.same = false;
  out.box = box, out.list_radius = cutoff(skin) * (1 + kBoxRoundOff);
  return out;
}

template <class Cell>
void NeighborBuilder::SortedItems::sort(const CellGrid& cells, Index count, const Cell& cell) {
  grid = cells;
  start.assign(static_cast<std::size_t>(grid.count()) + 1, 0);
  cell_of.resize(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    cell_of[i] = cell(i);
    if (cell_of[i] >= 0) ++start[cell_of[i] + 1];
  }
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
  items.resize(static_cast<std::size_t>(start.back()));
  std::vector<Index>& next = start;  // shifted by one slot while filling, restored below
  for (Index i = 0; i < count; ++i)
    if (cell_of[i] >= 0) items[next[cell_of[i]]++] = i;
  for (std::size_t c = next.size() - 1; c > 0; --c) next[c] = next[c - 1];
  next[0] = 0;
}

void NeighborBuilder::collect_row(const ParticleStore& store, Index i, NeighborList& list) const {
  const CellGrid& grid = near_.grid;
  const Vec4 p = store.position[i];
  const Index cell = near_.cell_of[i];
  if (cell < 0) return;
  const Index cx = cell % grid.cells[0], cy = cell / grid.cells[0] % grid.cells[1],
              cz = cell / (grid.cells[0] * grid.cells[1]);
  const Index x0 = std::max(cx - 1, 0), x1 = std::min(cx + 1, grid.cells[0] - 1);
  const Real margin = search_margin(list.skin);
  std::size_t count = list.neighbors.size();
  for (Index z = std::max(cz - 1, 0); z <= std::min(cz + 1, grid.cells[2] - 1); ++z)
    for (Index y = std::max(cy - 1, 0); y <= std::min(cy + 1, grid.cells[1] - 1); ++y) {
      const Index first = near_.start[grid.index(x0, y, z)], last = near_.start[grid.index(x1, y, z) + 1];
      list.neighbors.resize(count + static_cast<std::size_t>(last - first));
      Index* const entries = list.neighbors.data();
      for (Index k = first; k < last; ++k) {
        const Index j = near_.items[k];
        const Vec4& q = store.position[j];  // a copy would go through memory
        const Vec3 d{p.x - q.x, p.y - q.y, p.z - q.z};
        const Real distance = p.w + q.w + margin;
        entries[count] = j;  // kept or overwritten: a branch would be mispredicted often
        count += static_cast<std::size_t>((dot(d, d) < distance * distance) & (j != i));
      }
    }
  list.neighbors.resize(count);
}

void NeighborBuilder::build(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                            const ListedSurfaces& surfaces, Real skin, NeighborList& list) {
  list.skin = skin;
  list.neighbors.clear();
  list.offsets.assign(static_cast<std::size_t>(layout.owned) + 1, 0);
  sort(store, layout, cells);
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
  sort(store, layout, cells);
  find_surfaces(store, layout, surfaces, skin, rows);
}

void NeighborBuilder::sort(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells) {
  near_.sort(cells.own, layout.items, [&](Index i) {
    const bool searched = i < layout.active || i >= layout.owned;
    return searched ? cells.cell(xyz(store.position[i])) : -1;
  });
}

void NeighborBuilder::find_surfaces(const ParticleStore& store, const ItemLayout& layout,
                                    const ListedSurfaces& surfaces, Real skin, SurfaceRows& rows) const {
  const SortedParticles sorted{near_.grid,     near_.start,   near_.items,
                               store.position, layout.active, largest_radius_};
  build_rows(sorted, layout.owned,
             {surfaces_, planes_, surfaces.poses, period_, search_margin(skin) + surfaces.reach,
              surfaces.stored_contacts},
             rows);
}

}  // namespace scree
