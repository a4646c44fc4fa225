#include "dem/neighbor_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace scree {

NeighborBuilder::NeighborBuilder(const Model& model, const BodyShapes& shapes)
    : model_(model), shapes_(shapes) {
  largest_radius_ = model.particles.totals.largest_radius;
  for (const ShapeItem& s : shapes.items()) largest_radius_ = std::max(largest_radius_, s.radius);
}

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
  return out;
}

void NeighborBuilder::sort_into_cells(const ParticleStore& store, const ItemLayout& layout,
                                      const SearchCells& cells) {
  cell_start_.assign(static_cast<std::size_t>(cells.own.count()) + 1, 0);
  cell_of_.resize(static_cast<std::size_t>(layout.items));
  for (Index i = 0; i < layout.items; ++i) {
    const bool searched = i < layout.active || i >= layout.owned;
    const Index cell = searched ? cells.cell(xyz(store.position[i])) : -1;
    cell_of_[i] = cell;
    if (cell >= 0) ++cell_start_[cell + 1];
  }
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  cell_items_.resize(static_cast<std::size_t>(cell_start_.back()));
  std::vector<Index>& next = cell_start_;  // shifted by one slot while filling, restored below
  for (Index i = 0; i < layout.items; ++i)
    if (cell_of_[i] >= 0) cell_items_[next[cell_of_[i]]++] = i;
  for (std::size_t c = next.size() - 1; c > 0; --c) next[c] = next[c - 1];
  next[0] = 0;
}

// Which pairs a row leaves out: an image of a shape sees owned particles only (its contacts with other shapes
// are those of the original, on one rank), ghosts have no row of their own and shapes leave them to the
// original's images.
bool NeighborBuilder::excluded(const ItemLayout& layout, Index i, Index j) const {
  if (i == j) return true;
  if (i < layout.first_shape) return false;
  if (j < layout.owned) return false;
  if (j < layout.first_shape || layout.is_shape_image(i) || !layout.shapes_meet) return true;
  return !shapes_.may_touch(shapes_.items()[layout.shape_of(i)].body,
                            shapes_.items()[layout.shape_of(j)].body);
}

void NeighborBuilder::collect_row(const ParticleStore& store, const ItemLayout& layout, const CellGrid& grid,
                                  Index i, NeighborList& list) {
  const Vec4 p = store.position[i];
  const Index cell = cell_of_[i];
  const Index cx = cell % grid.cells[0], cy = cell / grid.cells[0] % grid.cells[1],
              cz = cell / (grid.cells[0] * grid.cells[1]);
  const Index x0 = std::max(cx - 1, 0), x1 = std::min(cx + 1, grid.cells[0] - 1);
  for (Index z = std::max(cz - 1, 0); z <= std::min(cz + 1, grid.cells[2] - 1); ++z)
    for (Index y = std::max(cy - 1, 0); y <= std::min(cy + 1, grid.cells[1] - 1); ++y)
      for (Index k = cell_start_[grid.index(x0, y, z)]; k < cell_start_[grid.index(x1, y, z) + 1]; ++k) {
        const Index j = cell_items_[k];
        const Vec4 q = store.position[j];
        const Vec3 d = xyz(p) - xyz(q);
        const Real reach = p.w + q.w + list.skin;
        if (dot(d, d) < reach * reach && !excluded(layout, i, j)) list.neighbors.push_back(j);
      }
}

// By global id, then by image: the same order whatever the local indices are.
void NeighborBuilder::order_row(const ParticleStore& store, const ItemLayout& layout, Index* first,
                                Index* last) const {
  const auto image = [&](Index j) {
    if (j < layout.owned) return kNoShift;
    if (j < layout.first_shape) return layout.ghost_images[j - layout.owned];
    return layout.is_shape_image(j) ? layout.shape_images[j - layout.first_shape - layout.shapes].image
                                    : kNoShift;
  };
  std::sort(first, last, [&](Index a, Index b) {
    const GlobalId ia = store.global_id[a], ib = store.global_id[b];
    return ia != ib ? ia < ib : image(a) < image(b);
  });
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
  list.neighbors.clear();
  list.offsets.assign(static_cast<std::size_t>(layout.items) + 1, 0);
  sort_into_cells(store, layout, cells);
  for (Index i = 0; i < layout.items; ++i) {
    const Index begin = static_cast<Index>(list.neighbors.size());
    const bool has_row = i < layout.active || i >= layout.first_shape;
    if (has_row && cell_of_[i] >= 0) collect_row(store, layout, cells.own, i, list);
    order_row(store, layout, list.neighbors.data() + begin, list.neighbors.data() + list.neighbors.size());
    if (list.neighbors.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
      throw SimulationError("stage neighbors: more neighbours than one rank can count");
    list.offsets[i + 1] = static_cast<Index>(list.neighbors.size());
  }
  collect_walls(store, layout, list);
}

}  // namespace scree
