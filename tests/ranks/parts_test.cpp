// Components used by several ranks, under mpirun with any number of ranks: collectives, boxes, halo.
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <vector>

#include "base/error.hpp"
#include "model/derived/random.hpp"
#include "partition/decomposition.hpp"
#include "partition/halo.hpp"
#include "partition/ranks.hpp"
#include "support/catch.hpp"
#include "support/petsc_run.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {

namespace {

Ranks world() {
  petsc();
  return Ranks::world();
}

Space box_space(int dimension, int periodic_axes) {
  Space space;
  space.dimension = dimension;
  space.min = {-1, 0.5, dimension == 3 ? 0.25 : 0.0}, space.max = {1, 1.9, dimension == 3 ? 1.3 : 0.0};
  for (int side = 0; side < 2 * periodic_axes; ++side)
    space.boundary[static_cast<std::size_t>(side)] = Boundary::periodic;
  return space;
}

struct Points {
  std::vector<Vec4> position;  // of all ranks
  std::vector<std::int64_t> weight;
};

// Random points, denser at smaller x.
Points random_points(const Space& space, int count, std::uint64_t seed) {
  RandomNumbers random(seed);
  const Subdomain subdomain(space);
  Points points;
  for (int i = 0; i < count; ++i) {
    const Real u = random.uniform(0, 1);
    const Vec3 extent = space.max - space.min;
    Vec3 p = space.min + Vec3{u * u * extent.x, random.uniform(0, 1) * extent.y,
                              space.dimension == 3 ? random.uniform(0, 1) * extent.z : 0};
    ImageCount unused;
    p = subdomain.wrap(snap(p, subdomain.snap_constant()), unused);
    points.position.push_back(vec4(p, 0.05));
    points.weight.push_back(1 + i % 3);
  }
  return points;
}

// Every size()-th point, before the migration to their ranks.
Points dealt(const Points& points, const Ranks& ranks) {
  Points own;
  for (std::size_t i = static_cast<std::size_t>(ranks.rank()); i < points.position.size();
       i += static_cast<std::size_t>(ranks.size())) {
    own.position.push_back(points.position[i]);
    own.weight.push_back(points.weight[i]);
  }
  return own;
}

}  // namespace

TEST_CASE("collectives are exact, and a NaN wins") {
  const Ranks ranks = world();
  const int n = ranks.size(), r = ranks.rank();
  CHECK(ranks.max(static_cast<Real>(r)) == n - 1);
  CHECK(std::isnan(ranks.max(r == n - 1 ? std::nan("") : std::numeric_limits<Real>::infinity())));
  CHECK(ranks.any(r == n - 1));
  CHECK_FALSE(ranks.any(false));
  CHECK(ranks.min(10 - r) == 11 - n);
  CHECK(ranks.sum(static_cast<std::int64_t>(r)) == n * (n - 1) / 2);
  const __int128 huge = static_cast<__int128>(1) << 100;
  __int128 sums[2] = {huge + r, -huge - 3 * r};
  ranks.sum(std::span<__int128>(sums));
  CHECK((sums[0] == huge * n + n * (n - 1) / 2));
  CHECK((sums[1] == -huge * n - 3 * n * (n - 1) / 2));
}

TEST_CASE("ranks of one host count through, so that each takes the GPU of its number") {
  const Ranks ranks = world();
  CHECK(ranks.local_rank() == ranks.rank());  // the tests run on one host
}

TEST_CASE("contents find their ranks") {
  const Ranks ranks = world();
  const int n = ranks.size(), r = ranks.rank();
  std::vector<std::vector<int>> to(static_cast<std::size_t>(n));
  for (int other = 0; other < n; ++other)
    to[static_cast<std::size_t>(other)].assign(static_cast<std::size_t>(r), 100 * r + other);
  std::vector<int> expected, all;
  for (int sender = 0; sender < n; ++sender) {
    expected.insert(expected.end(), static_cast<std::size_t>(sender), 100 * sender + r);
    all.insert(all.end(), static_cast<std::size_t>(sender), sender);
  }
  CHECK(ranks.all_to_all(to) == expected);
  const std::vector<int> own(static_cast<std::size_t>(r), r);
  CHECK(ranks.all_gather(own) == all);
  CHECK(ranks.gather(own) == (r == 0 ? all : std::vector<int>{}));
}

TEST_CASE("an exception of rank 0 is thrown on every rank, with its type and message") {
  const Ranks ranks = world();
  int runs = 0;
  ranks.on_root([&] { ++runs; });
  CHECK(runs == (ranks.is_root() ? 1 : 0));
  const auto message = [&](const auto& error) {
    try {
      ranks.on_root([&] { throw error; });
    } catch (const std::decay_t<decltype(error)>& caught) {
      return std::string(caught.what());
    }
    return std::string("nothing");
  };
  CHECK(message(InputError("one")) == "one");
  CHECK(message(SimulationError("two")) == "two");
  CHECK(message(DeviceError("three")) == "three");
  CHECK(message(IoError("four")) == "four");
}

TEST_CASE("boxes fill the grid, own their points, and weigh as much as layers of cells allow") {
  const Ranks ranks = world();
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    const Space space = box_space(dimension, 1);
    const Points all = random_points(space, 3000, 4), own = dealt(all, ranks);
    const DomainGrid grid = make_domain_grid(space, 0.05);
    const Decomposition boxes(ranks, grid, own.position, own.weight);
    double cells = 0;
    for (const CellBox& box : boxes.boxes()) {
      CHECK(box.count() >= 1);
      cells += box.count();
    }
    CHECK(cells == grid.count());
    std::vector<std::int64_t> weight(static_cast<std::size_t>(ranks.size()));
    std::int64_t total = 0;
    for (std::size_t i = 0; i < all.position.size(); ++i) {
      const Vec3 p = xyz(all.position[i]);
      const int owner = boxes.owner(p);
      const CellBox& box = boxes.boxes()[static_cast<std::size_t>(owner)];
      const Index at[3] = {grid.cell(0, p), grid.cell(1, p), grid.cell(2, p)};
      for (int axis = 0; axis < 3; ++axis) CHECK((at[axis] >= box.lower[axis] && at[axis] < box.upper[axis]));
      weight[static_cast<std::size_t>(owner)] += all.weight[i], total += all.weight[i];
    }
    // A layer of cells holds a few per cent of the points.
    for (const std::int64_t one : weight)
      CHECK(std::abs(static_cast<double>(one) * ranks.size() / static_cast<double>(total) - 1) < 0.3);
  }
}

TEST_CASE("as many ranks as cells are possible, more are refused on every rank") {
  const Ranks ranks = world();
  Space space = box_space(2, 0);
  space.min = {0, 0, 0}, space.max = {static_cast<Real>(ranks.size()), 1, 0};
  const Decomposition boxes(ranks, make_domain_grid(space, 1), {}, {});
  for (const CellBox& box : boxes.boxes()) CHECK(box.count() == 1);
  if (ranks.alone()) return;
  CHECK_THROWS_AS(Decomposition(ranks, make_domain_grid(space, 1.1), {}, {}), InputError);
}

TEST_CASE("ghosts are the particles and images near the box, as brute force finds them") {
  const Ranks ranks = world();
  using Entry = std::tuple<std::int64_t, int, Real, Real, Real, Real>;  // id, image, position, velocity
  for (const int dimension : {2, 3})
    for (int periodic_axes = 0; periodic_axes <= dimension; ++periodic_axes) {
      CAPTURE(dimension, periodic_axes);
      const Real width = 0.15;
      const Space space = box_space(dimension, periodic_axes);
      const Subdomain subdomain(space);
      const Points all = random_points(space, 500, 9), own = dealt(all, ranks);
      const Decomposition boxes(ranks, make_domain_grid(space, width), own.position, own.weight);

      std::vector<Vec4> position, velocity;
      std::vector<std::int64_t> id;
      std::set<Entry> expected;
      const Vec3 period = subdomain.period();
      DomainBox box = boxes.box(ranks.rank(), subdomain);
      if (ranks.alone()) box = {space.min, space.max};
      for (std::size_t i = 0; i < all.position.size(); ++i) {
        const Vec3 p = xyz(all.position[i]);
        const bool mine = boxes.owner(p) == ranks.rank();
        if (mine) position.push_back(all.position[i]), id.push_back(static_cast<std::int64_t>(i));
        for_each_shift(period, [&](Vec3 shift, int image) {
          if (image == kZeroShift && (mine || ranks.alone())) return;
          const Vec3 q = p + shift;
          if (q.x >= box.min.x - width && q.x <= box.max.x + width && q.y >= box.min.y - width &&
              q.y <= box.max.y + width && q.z >= box.min.z - width && q.z <= box.max.z + width)
            expected.emplace(i, image, q.x, q.y, q.z, static_cast<Real>(i));
        });
      }
      for (const std::int64_t i : id) velocity.push_back({static_cast<Real>(i), 0, 0, 1});
      Halo halo;
      const auto owned = static_cast<Index>(position.size());
      halo.exchange(ranks, boxes, subdomain, position, width);
      const auto items = static_cast<std::size_t>(owned + halo.size());
      position.resize(items), velocity.resize(items), id.resize(items);
      halo.update(std::span<std::int64_t>(id), owned);
      halo.update_motion(position, velocity, {}, owned);
      std::set<Entry> found;
      for (std::size_t g = static_cast<std::size_t>(owned); g < items; ++g) {
        const Vec4 p = position[g];
        CHECK(p.w == 0.05);
        found.emplace(id[g], halo.images()[g - static_cast<std::size_t>(owned)], p.x, p.y, p.z,
                      velocity[g].x);
      }
      CHECK(found.size() == static_cast<std::size_t>(halo.size()));
      CHECK((found == expected));
      const auto received =
          static_cast<std::int64_t>(halo.size()) - static_cast<std::int64_t>(halo.own().size());
      CHECK(ranks.sum(std::int64_t{halo.sent()}) == ranks.sum(received));
      CHECK((halo.receivers() > 0) == (halo.sent() > 0));
      CHECK(halo.receivers() < ranks.size());
    }
}

TEST_CASE("more ghosts than an Index counts are refused") {
  const Ranks ranks = world();
  const Space space = box_space(2, 1);
  const Points all = random_points(space, 500, 9), own = dealt(all, ranks);
  const Decomposition boxes(ranks, make_domain_grid(space, 0.15), own.position, own.weight);
  HaloPlan plan(ranks, boxes, Subdomain(space), 0.15);
  constexpr std::size_t kMost = std::numeric_limits<Index>::max();
  const std::vector<std::size_t> none(plan.neighbors().size());
  plan.set_counts(kMost, none);
  CHECK((plan.own() == kMost && plan.ghosts() == kMost));
  CHECK_THROWS_AS(plan.set_counts(kMost + 1, none), SimulationError);
  REQUIRE(none.empty() == ranks.alone());
  if (ranks.alone()) return;
  std::vector<std::size_t> sent(none.size(), 1);  // to and from each neighbour
  plan.set_counts(kMost - sent.size(), sent);
  CHECK(plan.ghosts() == kMost);
  CHECK_THROWS_AS(plan.set_counts(kMost - sent.size() + 1, sent), SimulationError);
  sent.back() = kMost, sent.front() += sent.size() > 1 ? 0 : 1;  // kMost + 1 in all, or more
  CHECK_THROWS_AS(plan.set_counts(0, sent), SimulationError);
}

// Takes 14 GB of memory, so that it runs only on request: mpirun -n 2 test_ranks "[large]".
TEST_CASE("a message between two ranks may be longer than 2 GiB", "[.][large]") {
  const Ranks ranks = world();
  REQUIRE(ranks.size() == 2);
  constexpr Index kGhosts = 68'000'000;
  static_assert(kGhosts * sizeof(Vec4) > (std::size_t(1) << 31));
  Space space = box_space(2, 0);
  space.min = {0, 0, 0}, space.max = {2, 1, 0};
  const std::vector<Vec4> one{{ranks.rank() + 0.5, 0.5, 0, 0}};
  const std::int64_t weight = 1;
  const Decomposition boxes(ranks, make_domain_grid(space, 1), one, {&weight, 1});
  // All of rank 0's particles are near rank 1's box.
  std::vector<Vec4> field(ranks.is_root() ? kGhosts : 0, Vec4{0.99, 0.5, 0, 0});
  Halo halo;
  halo.exchange(ranks, boxes, Subdomain(space), field, 0.1);
  CHECK(halo.size() == (ranks.is_root() ? 0 : kGhosts));
  for (std::size_t i = 0; i < field.size(); ++i) field[i].w = static_cast<Real>(i);
  if (!ranks.is_root()) field.resize(kGhosts);
  halo.update(std::span<Vec4>(field), ranks.is_root() ? kGhosts : 0);
  Index wrong = 0;
  for (std::size_t i = 0; i < field.size(); ++i) wrong += field[i].w != static_cast<Real>(i);
  CHECK(wrong == 0);
}

}  // namespace scree
