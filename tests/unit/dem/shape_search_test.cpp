// The neighbour lists of several ranks' boxes with very many shapes, against the list of one rank.
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "dem/neighbor_list.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

constexpr Real kSpacing = 0.1, kRadius = 0.05, kSkin = 0.02;
constexpr int kRanks = 4;

// A flat lattice of discs that begins at x = start in a space of some width; each square of side by side of
// them is a body. Particles lie half a spacing away from them, one per five, and in rows along the space.
struct Lattice {
  Lattice(Real width, Real start, int columns, int rows, int side) {
    model.space.dimension = 2;
    model.space.min = {0, 0, 0}, model.space.max = {width, kSpacing * (rows + 4), 0};
    std::map<std::pair<int, int>, std::size_t> bodies;
    for (int k = 0; k < columns * rows; ++k) {
      const int x = k % columns, y = k / columns;
      const auto [at, is_new] = bodies.try_emplace({x / side, y / side}, model.bodies.size());
      if (is_new) model.bodies.emplace_back();
      const Vec3 corner = Vec3{start, 0, 0} + kSpacing * Vec3{x + 1.0, y + 1.0, 0};
      model.bodies[at->second].shapes.push_back({corner + kSpacing * Vec3{0.5, 0.5, 0}, kRadius, 0});
      if (k % 5 == 0) add_particle(corner);
    }
    for (int k = 0; k < 200; ++k) add_particle({width * (k + 0.5) / 200, kSpacing * (1 + k % 3), 0});
    count_particles(model.particles, 1);
  }
  void add_particle(Vec3 p) {
    ParticleSet& set = model.particles;
    set.position.push_back(p), set.velocity.emplace_back();
    set.radius.push_back(kRadius), set.mass.push_back(1), set.material.push_back(0);
  }
  Model model;
};

// Global ids; without periodic sides they name an item.
using Rows = std::map<GlobalId, std::vector<GlobalId>>;

struct RankList {
  Rows rows;
  std::int64_t distances = 0;  // computed for it
};

// The list of the particles in `box` and of all shapes, as rank `rank` builds it; box: null for one rank
// alone.
RankList list_of(const Model& model, const DomainBox* box, bool shapes_meet) {
  const BodyShapes shapes(model);
  NeighborBuilder builder(model, shapes);
  ParticleStore store;
  ItemLayout layout;
  const auto all = static_cast<GlobalId>(model.particles.size());
  const auto add = [&](Vec3 p, GlobalId id) {
    store.position.push_back(vec4(p, kRadius)), store.row_key.push_back(row_key(id));
  };
  const auto add_particles = [&](bool owned) {
    for (GlobalId id = 0; id < all; ++id) {
      const Vec3 p = model.particles.position[static_cast<std::size_t>(id)];
      const bool mine = !box || (p.x >= box->min.x && p.x < box->max.x);
      const bool near = !box || box->reaches(p, builder.cutoff(kSkin));
      if (owned ? mine : near && !mine) add(p, id);
    }
    return static_cast<Index>(store.position.size());
  };
  layout.owned = layout.active = add_particles(true);
  layout.first_shape = add_particles(false);
  for (const ShapeItem& shape : shapes.items()) add(shape.offset, shape.global_id);
  layout.shapes = shapes.size(), layout.items = static_cast<Index>(store.position.size());
  layout.shapes_meet = shapes_meet;

  NeighborList list;
  const SearchCells cells =
      box ? builder.cells(kSkin, all, *box, layout.owned + layout.shapes) : builder.cells(kSkin, all);
  builder.build(store, layout, cells, kSkin, list);
  RankList out;
  out.distances = builder.distances();
  for (Index i = 0; i < layout.items; ++i) {
    if (i >= layout.owned && i < layout.first_shape) continue;
    std::vector<GlobalId>& row = out.rows[id_of(store.row_key[static_cast<std::size_t>(i)])];
    for (Index k = list.offsets[static_cast<std::size_t>(i)];
         k < list.offsets[static_cast<std::size_t>(i) + 1]; ++k)
      row.push_back(
          id_of(store.row_key[static_cast<std::size_t>(list.neighbors[static_cast<std::size_t>(k)])]));
  }
  return out;
}

// Slabs of equal width.
DomainBox box_of(const Model& model, int rank) {
  const Real width = model.space.max.x / kRanks;
  return {{rank == 0 ? -kInfinity : width * rank, -kInfinity, -kInfinity},
          {rank == kRanks - 1 ? kInfinity : width * (rank + 1), kInfinity, kInfinity}};
}

}  // namespace

TEST_CASE("the ranks' rows are together those of one rank, each pair of shapes once") {
  const Model model = Lattice(40, 0, 390, 6, 3).model;
  const Rows expected = list_of(model, nullptr, true).rows;
  const auto particles = static_cast<GlobalId>(model.particles.size());
  Rows found;
  std::size_t shape_pairs = 0;
  for (int rank = 0; rank < kRanks; ++rank) {
    const DomainBox box = box_of(model, rank);
    for (const auto& [id, row] : list_of(model, &box, rank == 0).rows) {
      if (id < particles) CHECK(found.count(id) == 0);
      std::vector<GlobalId>& all = found[id];
      all.insert(all.end(), row.begin(), row.end());
      std::sort(all.begin(), all.end());
      if (id >= particles)
        shape_pairs +=
            static_cast<std::size_t>(row.end() - std::lower_bound(row.begin(), row.end(), particles));
    }
  }
  CHECK(shape_pairs > 1000);
  CHECK((found == expected));
}

// All shapes lie in the last box, past the edge of the other ranks' cells.
TEST_CASE("shapes far from a rank's box do not slow its list down") {
  const Model model = Lattice(2000, 1550, 4000, 5, 1).model;
  const std::int64_t alone = list_of(model, nullptr, true).distances;
  for (int rank = 0; rank < kRanks; ++rank) {
    const DomainBox box = box_of(model, rank);
    const std::int64_t distances = list_of(model, &box, rank == 0).distances;
    CAPTURE(rank, distances, alone);
    CHECK(distances < alone);  // hundreds of times where the search is quadratic
  }
}

}  // namespace scree
