#include "dem/neighbor_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/countable.hpp"

namespace scree {

NeighborBuilder::NeighborBuilder(const Model& model, const BodyShapes& shapes)
    : model_(model), shapes_(shapes), largest_radius_(radius_range(model).largest) {}

namespace {

// Cells for so many items, countable by an Index.
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
                                        cutoff(skin), most_cells(particles + shapes_.size()));
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
  out.box = box, out.reach = cutoff(skin) * (1 + kBoxRoundOff);
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

// Over the searched shapes, wherever they are.
CellGrid NeighborBuilder::shape_grid(const ParticleStore& store, const ItemLayout& layout,
                                     const SearchCells& cells, Real skin) const {
  Vec3 min = model_.space.max, max = model_.space.min;
  for (Index i = layout.first_shape; i < layout.items; ++i) {
    const Vec3 p = xyz(store.position[i]);
    if (cells.space.cell(p) < 0) continue;
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  return make_cell_grid(min, max, model_.space.dimension, cutoff(skin),
                        most_cells(layout.items - layout.first_shape));
}

// Which pairs a row leaves out: an image of a shape sees owned particles only (its contacts with other shapes
// are those of the original, on one rank), ghosts have no row of their own and shapes leave them to the
// original's images.
bool NeighborBuilder::excluded(const ItemLayout& layout, Index i, Index j) const {
  if (i == j) return true;
  if (i < layout.first_shape) return false;
  if (j < layout.owned) return false;
  if (j < layout.first_shape || layout.is_shape_image(i) || !layout.shapes_meet) return true;
  return !shapes_.rule().may_touch(shapes_.items()[layout.shape_of(i)].body,
                                   shapes_.items()[layout.shape_of(j)].body);
}

void NeighborBuilder::collect_row(const ParticleStore& store, const ItemLayout& layout,
                                  const SortedItems& sorted, Index i, Index end, NeighborList& list) {
  const CellGrid& grid = sorted.grid;
  const Vec4 p = store.position[i];
  const Index cell = sorted.cell_of[i];
  if (cell < 0) return;
  const Index cx = cell % grid.cells[0], cy = cell / grid.cells[0] % grid.cells[1],
              cz = cell / (grid.cells[0] * grid.cells[1]);
  const Index x0 = std::max(cx - 1, 0), x1 = std::min(cx + 1, grid.cells[0] - 1);
  for (Index z = std::max(cz - 1, 0); z <= std::min(cz + 1, grid.cells[2] - 1); ++z)
    for (Index y = std::max(cy - 1, 0); y <= std::min(cy + 1, grid.cells[1] - 1); ++y) {
      const Index first = sorted.start[grid.index(x0, y, z)], last = sorted.start[grid.index(x1, y, z) + 1];
      distances_ += last - first;
      for (Index k = first; k < last; ++k) {
        const Index j = sorted.items[k];
        const Vec4 q = store.position[j];
        const Vec3 d = xyz(p) - xyz(q);
        const Real reach = p.w + q.w + list.skin;
        if (dot(d, d) < reach * reach && j < end && !excluded(layout, i, j)) list.neighbors.push_back(j);
      }
    }
}

void NeighborBuilder::collect_walls(const ParticleStore& store, const ItemLayout& layout,
                                    NeighborList& list) const {
  list.walls.clear();
  list.wall_offsets.assign(static_cast<std::size_t>(layout.items) + 1, 0);
  const Index last_shape = layout.first_shape + (layout.shapes_meet ? layout.shapes : 0);
  for (Index i = 0; i < layout.items; ++i) {
    const bool collides = i < layout.active || (i >= layout.first_shape && i < last_shape);
    for (Index w = 0; collides && w < static_cast<Index>(model_.walls.size()); ++w) {
      const Wall& wall = model_.walls[w];
      const Real distance = dot(xyz(store.position[i]) - wall.point, wall.normal);
      if (distance < store.position[i].w + list.skin) list.walls.push_back(w);
    }
    list.wall_offsets[i + 1] = static_cast<Index>(list.walls.size());
  }
}

void NeighborBuilder::build(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                            Real skin, NeighborList& list) {
  list.skin = skin;
  distances_ = 0;
  list.neighbors.clear();
  list.offsets.assign(static_cast<std::size_t>(layout.items) + 1, 0);
  // Shapes that reach no particle of this rank are left out of its cells, whose edges they would crowd.
  near_.sort(cells.own, layout.items, [&](Index i) {
    const Vec3 p = xyz(store.position[i]);
    const bool searched = i < layout.active || (i >= layout.owned && i < layout.first_shape) ||
                          (i >= layout.first_shape && cells.reaches(p));
    return searched ? cells.cell(p) : -1;
  });
  const bool shapes_apart = layout.shapes_meet && !cells.same && layout.items > layout.first_shape;
  if (shapes_apart) {
    const CellGrid grid = shape_grid(store, layout, cells, skin);
    all_shapes_.sort(grid, layout.items, [&](Index i) {
      const Vec3 p = xyz(store.position[i]);
      return i >= layout.first_shape && cells.space.cell(p) >= 0 ? grid.nearest(p) : -1;
    });
  }
  for (Index i = 0; i < layout.items; ++i) {
    const Index begin = static_cast<Index>(list.neighbors.size());
    const bool is_shape = i >= layout.first_shape;
    if (i < layout.active || is_shape)
      collect_row(store, layout, near_, i, is_shape && shapes_apart ? layout.first_shape : layout.items,
                  list);
    if (is_shape && shapes_apart) collect_row(store, layout, all_shapes_, i, layout.items, list);
    std::sort(list.neighbors.begin() + begin, list.neighbors.end(),
              [&](Index a, Index b) { return store.row_key[a] < store.row_key[b]; });
    list.offsets[i + 1] = countable(list.neighbors.size(), "stage neighbors: more neighbours");
  }
  collect_walls(store, layout, list);
}

}  // namespace scree
