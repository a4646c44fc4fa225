// Full neighbour list with a skin, rows ordered by the neighbours' global ids.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/body_shapes.hpp"
#include "dem/particle_store.hpp"
#include "model/model.hpp"
#include "partition/cell_grid.hpp"
#include "partition/decomposition.hpp"
#include "partition/halo.hpp"

namespace scree {

// Row i holds every item that can touch item i before the list expires. Rows of ghosts and of particles
// outside the search are empty. A second list of the same form holds the walls near each item.
struct NeighborList {
  std::vector<Index> offsets, neighbors;   // [items + 1], [entries]
  std::vector<Index> wall_offsets, walls;  // [items + 1], [entries]: indices into Model::walls
  Real skin = 0;                           // reach past touching that this list covers [m]
};

// Where items of each kind stand in the store, and the body shapes' images across periodic sides.
struct ItemLayout {
  Index owned = 0, active = 0;  // owned particles, and those of them in the search
  Index first_shape = 0;        // after owned and ghosts
  Index items = 0;
  std::vector<Ghost> shape_images;  // of shapes: source counts from 0 within the shapes
  Index shapes = 0;                 // originals, before their images
  bool shapes_meet = true;  // whether this rank has the contacts of shapes with each other and with walls
  // Shape of an item >= first_shape, and whether the item is an image of it.
  Index shape_of(Index item) const {
    const Index s = item - first_shape;
    return s < shapes ? s : shape_images[static_cast<std::size_t>(s - shapes)].source;
  }
  bool is_shape_image(Index item) const { return item - first_shape >= shapes; }
};

// Cells that items are sorted into.
struct SearchCells {
  CellGrid space;  // the items in one of its cells are searched, on any number of ranks the same
  CellGrid own;    // over the box of this rank; with one rank the same
  bool same = true;
  DomainBox box{};  // of this rank, unless same
  Real reach = 0;   // of the list past the box [m]

  // In `own`; x is -1 for items that are not searched.
  SCREE_HD CellPlace place(Vec3 p) const {
    const CellPlace c = space.place(p);
    return c.x < 0 || same ? c : own.nearest_place(p);
  }
  Index cell(Vec3 p) const {
    const CellPlace c = place(p);
    return c.x < 0 ? -1 : own.index(c.x, c.y, c.z);
  }
  // Whether a shape there can touch a particle of this rank.
  SCREE_HD bool reaches(Vec3 p) const { return same || box.reaches(p, reach); }
};

class NeighborBuilder {
 public:
  NeighborBuilder(const Model& model, const BodyShapes& shapes);

  // The grid whose cells are at least one largest diameter plus skin wide.
  CellGrid grid(Real skin, Index items) const;
  // particles, items: of all ranks and of this one, for the number of cells.
  SearchCells cells(Real skin, std::int64_t particles) const;
  SearchCells cells(Real skin, std::int64_t particles, const DomainBox& box, Index items) const;
  // Largest distance of centres that the list must see: largest diameter plus skin [m].
  Real cutoff(Real skin) const { return 2 * largest_radius_ + skin; }
  // Fills the list from the positions of all items.
  void build(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells, Real skin,
             NeighborList& list);
  // Pairs of items whose distance the last build has computed.
  std::int64_t distances() const { return distances_; }

 private:
  // Items in the order of their cells.
  struct SortedItems {
    CellGrid grid;
    std::vector<Index> start, items;  // [cells + 1], [searched]
    std::vector<Index> cell_of;       // [all items]; -1 for those that are not searched

    // cell(item): where it belongs, or -1.
    template <class Cell>
    void sort(const CellGrid& cells, Index count, const Cell& cell);
  };
  CellGrid shape_grid(const ParticleStore& store, const ItemLayout& layout, const SearchCells& cells,
                      Real skin) const;
  // Adds the neighbours of item i among the sorted items before `end`.
  void collect_row(const ParticleStore& store, const ItemLayout& layout, const SortedItems& sorted, Index i,
                   Index end, NeighborList& list);
  bool excluded(const ItemLayout& layout, Index i, Index j) const;
  void collect_walls(const ParticleStore& store, const ItemLayout& layout, NeighborList& list) const;

  const Model& model_;
  const BodyShapes& shapes_;
  Real largest_radius_ = 0;
  std::int64_t distances_ = 0;
  SortedItems near_;        // what can touch this rank's particles, and those
  SortedItems all_shapes_;  // where shapes meet on a rank whose cells are not those of the space
};

}  // namespace scree
