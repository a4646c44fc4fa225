// The neighbour list against a search over all pairs and images.
#include "dem/search/neighbor_list.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "dem/explicit/paired_rows.hpp"
#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

// Identity of an entry: global id and number of the image.
using Entry = std::pair<GlobalId, int>;
constexpr Real kSkin = 0.03;
constexpr Index kParticles = 150, kDrifting = 7;

// Store and layout as a backend arranges them, from records in an arbitrary order.
struct Items {
  Items(const Model& model, const NeighborBuilder& builder) {
    const Subdomain subdomain(model.space);
    std::vector<Particle> records = initial_records(model.particles, subdomain);
    std::stable_sort(records.begin(), records.end() - kDrifting,
                     [](const auto& a, const auto& b) { return a.position.x < b.position.x; });
    store.load(records);
    layout.owned = kParticles, layout.active = kParticles - kDrifting;
    const Real width = builder.cutoff(kSkin);
    Halo halo;
    halo.exchange(Ranks(), {}, subdomain, {store.position.data(), static_cast<std::size_t>(layout.active)},
                  width);
    ghosts = halo.own();
    add_ghosts();
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

  int image_of(Index j) const {
    return j < layout.owned ? kZeroShift : ghosts[static_cast<std::size_t>(j - layout.owned)].image;
  }
  Vec4 position(Index j) const { return store.position[static_cast<std::size_t>(j)]; }
  GlobalId global_id(Index j) const { return id_of(store.row_key[static_cast<std::size_t>(j)]); }

  ParticleStore store;
  ItemLayout layout;
  std::vector<Ghost> ghosts;
};

// The expected row i: particles, and images of them and of itself.
std::vector<Entry> expected_row(const Items& items, Vec3 period, Index i) {
  std::vector<Entry> row;
  for (Index j = 0; j < items.layout.active; ++j)
    for_each_shift(period, [&](Vec3 shift, std::int8_t image) {
      const Vec4 p = items.position(i), q = items.position(j);
      const Vec3 d = xyz(p) - (xyz(q) + shift);
      const Real reach = p.w + q.w + kSkin;
      const bool itself = j == i && image == kZeroShift;
      if (dot(d, d) < reach * reach && !itself) row.emplace_back(items.global_id(j), image);
    });
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

struct BuiltList {
  BuiltList(const BoxCase& box, std::uint64_t seed) : BuiltList(random_box(box, kParticles, seed)) {}
  explicit BuiltList(const Model& of) : model(of), builder(model), items(model, builder) {
    builder.build(items.store, items.layout, builder.cells(kSkin, kParticles), {}, kSkin, list);
  }
  Model model;
  NeighborBuilder builder;
  Items items;
  NeighborList list;
};

void check_rows(const BuiltList& built) {
  const ItemLayout& layout = built.items.layout;
  REQUIRE(built.list.offsets.size() == static_cast<std::size_t>(layout.owned) + 1);
  const Vec3 period = Subdomain(built.model.space).period();
  for (Index i = 0; i < layout.owned; ++i) {
    CAPTURE(i);
    const std::vector<Entry> expected =
        i < layout.active ? expected_row(built.items, period, i) : std::vector<Entry>{};
    CHECK(found_row(built.items, built.list, i) == expected);
  }
}

// The first `large` particles have the largest radius, the others a tenth of it.
Model two_sizes(const BoxCase& box, Index large) {
  Model model = random_box(box, kParticles, 5);
  for (Index i = 0; i < kParticles; ++i)
    model.particles.radius[static_cast<std::size_t>(i)] = i < large ? kLargestRadius : kLargestRadius / 10;
  count_particles(model.particles, box.materials);
  return model;
}

}  // namespace

TEST_CASE("rows hold every pair and image in range, once, by global id and image") {
  for (const BoxCase& box : kBoxes)
    for (const std::uint64_t seed : {1, 2, 3}) {
      CAPTURE(box.name, seed);
      check_rows(BuiltList(box, seed));
    }
}

TEST_CASE("rows hold every pair and image at a size ratio of 1 : 10") {
  for (const BoxCase& box : kBoxes)
    for (const Index large : {1, 10, kParticles / 2}) {
      CAPTURE(box.name, large);
      check_rows(BuiltList(two_sizes(box, large)));
    }
}

TEST_CASE("every slot is that of one pair, of a particle or of its partner") {
  for (const BoxCase& box : kBoxes) {
    CAPTURE(box.name);
    const BuiltList built(box, 1);
    const NeighborList& list = built.list;
    const Index owned = built.items.layout.owned;
    PairList pairs;
    pairs.match(list, built.items.store);
    CHECK(pairs.is_current);
    CHECK(pairs.slots == list.neighbors.size());
    REQUIRE(pairs.rows() == owned);
    std::vector<int> uses(list.neighbors.size(), 0);
    for (Index i = 0; i < owned; ++i)
      for (Index k = pairs.offsets[i]; k < pairs.offsets[i + 1]; ++k) {
        const ListedPair& pair = pairs.pairs[k];
        CAPTURE(i, pair.j, pair.slot, pair.mirror);
        CHECK((list.offsets[i] <= pair.slot && pair.slot < list.offsets[i + 1]));
        CHECK(list.neighbors[pair.slot] == pair.j);
        ++uses[pair.slot];
        REQUIRE(pair.has_mirror() == (pair.j < owned));
        if (!pair.has_mirror()) continue;
        CHECK(i < pair.j);
        CHECK((list.offsets[pair.j] <= pair.mirror && pair.mirror < list.offsets[pair.j + 1]));
        CHECK(list.neighbors[pair.mirror] == i);
        ++uses[pair.mirror];
      }
    CHECK(std::count(uses.begin(), uses.end(), 1) == std::ssize(uses));
  }
}

TEST_CASE("the boxes of these tests have ghosts") {
  std::size_t ghosts = 0;
  for (const BoxCase& box : kBoxes) ghosts += BuiltList(box, 1).items.ghosts.size();
  CHECK(ghosts > 100);
}

TEST_CASE("ballistic particles are in no row") {
  for (const BoxCase& box : kBoxes) {
    const BuiltList built(box, 4);
    CAPTURE(box.name);
    for (const Index j : built.list.neighbors)
      CHECK((j < built.items.layout.active || j >= built.items.layout.owned));
    for (Index i = kParticles - kDrifting; i < kParticles; ++i)
      CHECK(found_row(built.items, built.list, i).empty());
  }
}

TEST_CASE("pair histories return to both slots, and a slot's previous history stays") {
  using Law = ContactLaw<LinearLaw, LinearSlider>;
  for (const BoxCase& box : kBoxes) {
    CAPTURE(box.name);
    const BuiltList built(box, 1);
    PairList pairs;
    pairs.match(built.list, built.items.store);
    std::vector<Vec4> slots(pairs.slots);
    for (std::size_t s = 0; s < slots.size(); ++s) slots[s] = {static_cast<Real>(s), 1, 2, 3};
    pairs.fetch_records(slots.data(), 1);
    REQUIRE(pairs.records.size() == pairs.pairs.size());
    for (std::size_t p = 0; p < pairs.pairs.size(); ++p) {
      CHECK(pairs.records[p].x == static_cast<Real>(pairs.pairs[p].slot));
      pairs.records[p] = {-static_cast<Real>(p), 0, 7, 4};
      if (p % 3 == 0 && pairs.pairs[p].has_mirror()) slots[pairs.pairs[p].mirror] = {5, 5, 5, 4};
    }
    HistoryViews history;
    history.neighbors = slots.data(), history.step = 4;
    return_records<Law>(pairs, history);
    CHECK_FALSE(pairs.has_records);
    for (std::size_t p = 0; p < pairs.pairs.size(); ++p) {
      const ListedPair& pair = pairs.pairs[p];
      CAPTURE(p, pair.slot, pair.mirror);
      const auto has = [&](Index slot, Vec3 spring) {
        return xyz(slots[slot]) == spring && slots[slot].w == 4;
      };
      CHECK(has(pair.slot, {-static_cast<Real>(p), 0, 7}));
      if (pair.has_mirror())
        CHECK(has(pair.mirror, p % 3 == 0 ? Vec3{5, 5, 5} : Vec3{static_cast<Real>(p), 0, -7}));
    }
  }
}

}  // namespace scree
