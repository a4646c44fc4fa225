// Rows of particles of many sizes on any number of ranks, against a search over all pairs and images.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dem/search/neighbor_list.hpp"
#include "model/derived/random.hpp"
#include "partition/decomposition.hpp"
#include "partition/halo.hpp"
#include "partition/ranks.hpp"
#include "support/catch.hpp"
#include "support/petsc_run.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {

namespace {

using Entry = std::pair<GlobalId, int>;  // id and image of a neighbour
constexpr Real kSkin = 0.02;
constexpr int kParticles = 1000;

// Radii from the largest down to 1 / ratio of it, as many in each interval of their logarithm; the particles
// crowd at small x, so that also the smallest have neighbours.
Model box_of_sizes(int dimension, int periodic_axes, Real ratio) {
  Model model = random_box({"", dimension, periodic_axes, 1, false, false, 1, 1, false}, kParticles, 21);
  RandomNumbers random(22);
  const Real from = model.space.min.x, width = model.space.max.x - from;
  for (std::size_t i = 0; i < model.particles.size(); ++i) {
    Real& x = model.particles.position[i].x;
    x = from + std::pow((x - from) / width, 3) * width;
    model.particles.radius[i] = kLargestRadius * std::pow(ratio, -random.uniform());
  }
  model.particles.radius[0] = kLargestRadius, model.particles.radius[1] = kLargestRadius / ratio;
  count_particles(model.particles, 1);
  return model;
}

// The items of a rank, and then their list, as a backend makes them.
struct RankRows {
  // wide: ghosts are all particles within the search distance of the largest.
  RankRows(const Ranks& ranks, const Model& model, const std::vector<Particle>& all, bool wide = false)
      : subdomain(model.space), builder(model) {
    std::vector<Vec4> position;
    const std::vector<std::int64_t> weight(ranks.is_root() ? all.size() : 0, 1);
    for (std::size_t i = 0; i < weight.size(); ++i) position.push_back(vec4(all[i].position, 0));
    if (!ranks.alone())
      boxes = {ranks, make_domain_grid(model.space, builder.cutoff(kSkin)), position, weight};
    std::vector<Particle> own;
    for (const Particle& particle : all)
      if (ranks.alone() || boxes.owner(particle.position) == ranks.rank()) own.push_back(particle);
    store.load(own);
    store.active = store.owned;
    lay_out(ranks, wide);
  }

  void build(const Ranks& ranks) {
    const SearchCells cells =
        ranks.alone() ? builder.cells(kSkin, kParticles)
                      : builder.cells(kSkin, kParticles, boxes.box(ranks.rank(), subdomain), store.owned);
    builder.build(store, layout, cells, {}, kSkin, list);
  }

  void lay_out(const Ranks& ranks, bool wide) {
    if (wide)
      halo.exchange(ranks, boxes, subdomain, store.position, builder.cutoff(kSkin));
    else
      halo.exchange(ranks, boxes, subdomain, store.position, builder.levels(),
                    builder.level_space(builder.search_margin(kSkin)));
    layout.owned = layout.active = store.owned, layout.items = store.owned + halo.size();
    store.resize_items(layout.items);
    halo.update(std::span(store.row_key), layout.owned);
    halo.update_motion(store.position, store.velocity, {}, layout.owned);
    for (Index g = 0; g < halo.size(); ++g) {
      std::int64_t& key = store.row_key[layout.owned + g];
      key = row_key(id_of(key), halo.images()[g]);
    }
  }

  std::vector<Entry> row(Index i) const {
    std::vector<Entry> out;
    for (Index k = list.offsets[i]; k < list.offsets[i + 1]; ++k) {
      const std::int64_t key = store.row_key[list.neighbors[k]];
      out.emplace_back(id_of(key), image_of(key));
    }
    return out;
  }

  Subdomain subdomain;
  NeighborBuilder builder;
  Decomposition boxes;
  ParticleStore store;
  Halo halo;
  ItemLayout layout;
  NeighborList list;
};

std::vector<Entry> expected_row(const std::vector<Particle>& all, Vec3 period, const Particle& of) {
  std::vector<Entry> row;
  for (const Particle& other : all)
    for_each_shift(period, [&](Vec3 shift, std::int8_t image) {
      const Vec3 d = of.position - (other.position + shift);
      const Real distance = of.radius + other.radius + kSkin;
      if (dot(d, d) < distance * distance && !(other.global_id == of.global_id && image == kZeroShift))
        row.emplace_back(other.global_id, image);
    });
  std::sort(row.begin(), row.end());
  return row;
}

}  // namespace

TEST_CASE("rows are those of brute force at any spread of sizes, on any number of ranks", "[rows]") {
  petsc();
  const Ranks ranks = Ranks::world();
  for (const int dimension : {2, 3})
    for (int periodic_axes = 0; periodic_axes <= dimension; ++periodic_axes)
      for (const Real ratio : {1, 3, 10, 100}) {
        CAPTURE(dimension, periodic_axes, ratio, ranks.size());
        const Model model = box_of_sizes(dimension, periodic_axes, ratio);
        const std::vector<Particle> all = initial_records(model.particles, Subdomain(model.space));
        RankRows rank(ranks, model, all), wide(ranks, model, all, true);
        rank.build(ranks), wide.build(ranks);
        std::int64_t entries = 0;
        for (Index i = 0; i < rank.store.owned; ++i) {
          const GlobalId id = id_of(rank.store.row_key[i]);
          const std::vector<Entry> expected =
              expected_row(all, rank.subdomain.period(), all[static_cast<std::size_t>(id)]);
          entries += std::ssize(expected);
          CAPTURE(id);
          REQUIRE(rank.row(i) == expected);
          REQUIRE(wide.row(i) == expected);
        }
        CHECK(rank.halo.size() <= wide.halo.size());
        CHECK(ranks.sum(std::int64_t{rank.store.owned}) == kParticles);
        CHECK(ranks.sum(entries) > kParticles);
      }
}

namespace {

// Spheres on a cubic lattice of spacing 1, of a diameter a little below it. A large one of this diameter
// replaces those inside it.
Model lattice(Real diameter) {
  constexpr int kSide = 26;
  Model model;
  model.space.dimension = 3;
  model.space.min = {0, 0, 0}, model.space.max = {kSide, kSide, kSide};
  model.space.boundary.fill(Boundary::periodic);
  const Vec3 middle{kSide / 2.0, kSide / 2.0, kSide / 2.0};  // a corner of the boxes of up to eight ranks
  const auto add = [&](Vec3 p, Real radius) {
    model.particles.position.push_back(p), model.particles.velocity.push_back({});
    model.particles.radius.push_back(radius), model.particles.mass.push_back(1);
    model.particles.material.push_back(0);
  };
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z)
        if (const Vec3 p{x + 0.5, y + 0.5, z + 0.5}; norm(p - middle) > diameter / 2 + 0.49) add(p, 0.49);
  if (diameter > 0) add(middle, diameter / 2);
  model.contact.material_names = {"material"}, model.contact.laws = {{1e3, 5.0, 1, false}};
  count_particles(model.particles, 1);
  return model;
}

std::int64_t ghosts_of(const Ranks& ranks, const Model& model, bool wide) {
  const RankRows rank(ranks, model, initial_records(model.particles, Subdomain(model.space)), wide);
  return ranks.sum(std::int64_t{rank.halo.size()});
}

}  // namespace

TEST_CASE("a sphere of six diameters on the corner of the boxes hardly adds ghosts", "[rows]") {
  petsc();
  const Ranks ranks = Ranks::world();
  const std::int64_t equal = ghosts_of(ranks, lattice(0), false), with = ghosts_of(ranks, lattice(6), false),
                     wide = ghosts_of(ranks, lattice(6), true);
  CAPTURE(ranks.size(), equal, with, wide);
  CHECK(static_cast<double>(with) <= 1.2 * static_cast<double>(equal));
  CHECK(wide > 2 * equal);
}

}  // namespace scree
