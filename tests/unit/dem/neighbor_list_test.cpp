// The neighbour list against a search over all pairs and images.
#include "dem/neighbor_list.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "random_box.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

// Identity of an entry: global id and number of the image.
using Entry = std::pair<GlobalId, int>;
constexpr Real kSkin = 0.03;
constexpr Index kParticles = 150, kDrifting = 7;

// Store and layout as a backend lays them out, from records in an order of their own.
struct Items {
  Items(const Model& model, const BodyShapes& shapes, const NeighborBuilder& builder) {
    const Subdomain subdomain(model.space);
    std::vector<Particle> records = initial_records(model.particles, subdomain);
    std::stable_sort(records.begin(), records.end() - kDrifting,
                     [](const auto& a, const auto& b) { return a.position.x < b.position.x; });
    store.load(records);
    layout.owned = kParticles, layout.active = kParticles - kDrifting, layout.shapes = shapes.size();
    const Real width = builder.cutoff(kSkin);
    ghosts =
        periodic_images(subdomain, {store.position.data(), static_cast<std::size_t>(layout.active)}, width);
    add_ghosts();
    layout.first_shape = static_cast<Index>(store.position.size());
    add_shapes(model, shapes, subdomain, width);
    layout.items = static_cast<Index>(store.position.size());
  }

  void add_ghosts() {
    for (const Ghost& ghost : ghosts) {
      const auto source = static_cast<std::size_t>(ghost.source);
      const Vec4 p = store.position[source];
      store.position.push_back(vec4(xyz(p) + ghost.shift, p.w));
      store.row_key.push_back(row_key(id_of(store.row_key[source]), ghost.image));
    }
  }

  void add_shapes(const Model& model, const BodyShapes& shapes, const Subdomain& subdomain, Real width) {
    const std::vector<BodyMotion> motion = motion_of(model.bodies);
    std::vector<Vec4> centers;
    for (const ShapeItem& shape : shapes.items()) {
      ImageCount unused;
      const Vec3 p = point_motion(motion[static_cast<std::size_t>(shape.body)], shape.offset).position;
      centers.push_back(vec4(subdomain.wrap(snap(p, subdomain.snap_constant()), unused), shape.radius));
      store.position.push_back(centers.back());
      store.row_key.push_back(row_key(shape.global_id));
    }
    layout.shape_images = periodic_images(subdomain, centers, width);
    for (const Ghost& image : layout.shape_images) {
      const auto source = static_cast<std::size_t>(image.source);
      store.position.push_back(vec4(xyz(centers[source]) + image.shift, centers[source].w));
      store.row_key.push_back(row_key(shapes.items()[source].global_id, image.image));
    }
  }

  int image_of(Index j) const {
    if (j < layout.owned) return kNoShift;
    if (j < layout.first_shape) return ghosts[static_cast<std::size_t>(j - layout.owned)].image;
    if (!layout.is_shape_image(j)) return kNoShift;
    return layout.shape_images[static_cast<std::size_t>(j - layout.first_shape - layout.shapes)].image;
  }
  Vec4 position(Index j) const { return store.position[static_cast<std::size_t>(j)]; }
  GlobalId global_id(Index j) const { return id_of(store.row_key[static_cast<std::size_t>(j)]); }

  ParticleStore store;
  ItemLayout layout;
  std::vector<Ghost> ghosts;
};

// What row i must hold, by the rules of the list: particles see particles, shapes and the images of both; a
// shape sees particles, and shapes that it may touch; an image of a shape sees particles only.
std::vector<Entry> expected_row(const Items& items, const BodyShapes& shapes, Vec3 period, Index i) {
  std::vector<Entry> row;
  const ItemLayout& layout = items.layout;
  const bool is_shape = i >= layout.first_shape;
  const auto body = [&](Index item) {
    return shapes.items()[static_cast<std::size_t>(layout.shape_of(item))].body;
  };
  const auto sees = [&](Index j, int image) {
    if (j < layout.active) return !is_shape ? !(j == i && image == kNoShift) : image == kNoShift;
    if (!is_shape) return true;
    return !layout.is_shape_image(i) && shapes.rule().may_touch(body(i), body(j));
  };
  const auto add = [&](Index j) {
    for_each_image(period, [&](Vec3 shift, int image) {
      const Vec4 p = items.position(i), q = items.position(j);
      const Vec3 d = xyz(p) - (xyz(q) + shift);
      const Real reach = p.w + q.w + kSkin;
      if (dot(d, d) < reach * reach && sees(j, image)) row.emplace_back(items.global_id(j), image);
    });
  };
  for (Index j = 0; j < layout.active; ++j) add(j);
  for (Index s = 0; s < layout.shapes; ++s) add(layout.first_shape + s);
  std::sort(row.begin(), row.end());
  return row;
}

std::vector<Entry> found_row(const Items& items, const NeighborList& list, Index i) {
  std::vector<Entry> row;
  for (Index k = list.offsets[static_cast<std::size_t>(i)]; k < list.offsets[static_cast<std::size_t>(i) + 1];
       ++k) {
    const Index j = list.neighbors[static_cast<std::size_t>(k)];
    row.emplace_back(items.global_id(j), items.image_of(j));
  }
  return row;
}

std::vector<Index> found_walls(const NeighborList& list, Index i) {
  return {list.walls.begin() + list.wall_offsets[static_cast<std::size_t>(i)],
          list.walls.begin() + list.wall_offsets[static_cast<std::size_t>(i) + 1]};
}

struct BuiltList {
  explicit BuiltList(const BoxCase& box, std::uint64_t seed)
      : model(random_box(box, kParticles, seed)),
        shapes(model),
        builder(model, shapes),
        items(model, shapes, builder) {
    builder.build(items.store, items.layout, builder.cells(kSkin, kParticles), kSkin, list);
  }
  Model model;
  BodyShapes shapes;
  NeighborBuilder builder;
  Items items;
  NeighborList list;
};

}  // namespace

TEST_CASE("rows hold every pair and image in reach, once, by global id and image") {
  for (const BoxCase& box : kBoxes)
    for (const std::uint64_t seed : {1, 2, 3}) {
      const BuiltList built(box, seed);
      CAPTURE(box.name, seed);
      const ItemLayout& layout = built.items.layout;
      REQUIRE(built.list.offsets.size() == static_cast<std::size_t>(layout.items) + 1);
      const Vec3 period = Subdomain(built.model.space).period();
      for (Index i = 0; i < layout.items; ++i) {
        CAPTURE(i);
        const bool has_row = i < layout.active || i >= layout.first_shape;
        const std::vector<Entry> expected =
            has_row ? expected_row(built.items, built.shapes, period, i) : std::vector<Entry>{};
        CHECK(found_row(built.items, built.list, i) == expected);
      }
    }
}

TEST_CASE("the boxes of these tests have every kind of entry") {
  std::size_t ghosts = 0, shape_images = 0, shape_pairs = 0, walls = 0;
  for (const BoxCase& box : kBoxes) {
    const BuiltList built(box, 1);
    const ItemLayout& layout = built.items.layout;
    ghosts += built.items.ghosts.size(), shape_images += layout.shape_images.size(),
        walls += built.list.walls.size();
    for (Index i = layout.first_shape; i < layout.first_shape + layout.shapes; ++i)
      for (const Entry& entry : found_row(built.items, built.list, i))
        shape_pairs += entry.first >= kParticles;
  }
  CHECK(ghosts > 100);
  CHECK(shape_images > 0);
  CHECK(shape_pairs > 0);
  CHECK(walls > 10);
}

TEST_CASE("particles that drift outside the space are in no row") {
  for (const BoxCase& box : kBoxes) {
    const BuiltList built(box, 4);
    CAPTURE(box.name);
    for (const Index j : built.list.neighbors)
      CHECK((j < built.items.layout.active || j >= built.items.layout.owned));
    for (Index i = kParticles - kDrifting; i < kParticles; ++i) {
      CHECK(found_row(built.items, built.list, i).empty());
      CHECK(found_walls(built.list, i).empty());
    }
  }
}

TEST_CASE("the wall list holds every wall in reach of a particle or a shape") {
  for (const BoxCase& box : kBoxes) {
    const BuiltList built(box, 5);
    CAPTURE(box.name);
    const ItemLayout& layout = built.items.layout;
    for (Index i = 0; i < layout.items; ++i) {
      const bool collides = i < layout.active || (i >= layout.first_shape && !layout.is_shape_image(i));
      std::vector<Index> expected;
      for (Index w = 0; collides && w < static_cast<Index>(built.model.walls.size()); ++w) {
        const Wall& wall = built.model.walls[static_cast<std::size_t>(w)];
        const Vec4 p = built.items.position(i);
        if (dot(xyz(p) - wall.point, wall.normal) < p.w + kSkin) expected.push_back(w);
      }
      CHECK(found_walls(built.list, i) == expected);
    }
  }
}

}  // namespace scree
