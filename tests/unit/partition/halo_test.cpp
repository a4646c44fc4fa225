// Ghosts: the images of a point near periodic sides, their positions, and their updates from the originals.
#include "partition/halo.hpp"

#include <set>
#include <vector>

#include "model/derived/random.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

constexpr Real kWidth = 0.1;

Space periodic_space(int dimension) {
  Space s;
  s.dimension = dimension;
  s.min = {0, 0, 0}, s.max = {1, 2, dimension == 3 ? 3.0 : 0.0};
  s.boundary.fill(Boundary::periodic);
  return s;
}

std::vector<Ghost> ghosts_of(const Space& s, const std::vector<Vec4>& points) {
  Halo halo;
  halo.exchange(Ranks(), {}, Subdomain(s), points, kWidth);
  return halo.own();
}

}  // namespace

TEST_CASE("a point has an image per periodic side that it is near, and per edge and corner") {
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    const Space s = periodic_space(dimension);
    const Real z = 0.5 * s.max.z;
    CHECK(ghosts_of(s, {{0.5, 1, z, 0.05}}).empty());
    CHECK(ghosts_of(s, {{0.05, 1, z, 0.05}}).size() == 1);
    CHECK(ghosts_of(s, {{0.95, 1.95, z, 0.05}}).size() == 3);
    CHECK(ghosts_of(s, {{0.05, 1.95, 0.02 * s.max.z, 0.05}}).size() == (dimension == 3 ? 7 : 3));
  }
}

TEST_CASE("ghosts lie within the width of the box, on shifts of their own, and every such image is a ghost") {
  RandomNumbers random(1);
  for (const int dimension : {2, 3}) {
    const Space s = periodic_space(dimension);
    const Vec3 period = Subdomain(s).period();
    std::vector<Vec4> points;
    for (int i = 0; i < 300; ++i) {
      const Real x = random.uniform(s.min.x, s.max.x), y = random.uniform(s.min.y, s.max.y);
      points.push_back({x, y, dimension == 3 ? random.uniform(s.min.z, s.max.z) : 0, 0.05});
    }
    std::set<std::pair<Index, int>> found;
    for (const Ghost& ghost : ghosts_of(s, points)) {
      CHECK(ghost.image != kZeroShift);
      CHECK(found.emplace(ghost.source, ghost.image).second);
    }
    std::set<std::pair<Index, int>> expected;
    const auto within = [](Real x, Real min, Real max) { return x >= min - kWidth && x <= max + kWidth; };
    for (Index i = 0; i < 300; ++i)
      for (int shift = 0; shift < 27; ++shift) {
        const int sx = shift % 3 - 1, sy = shift / 3 % 3 - 1, sz = shift / 9 - 1;
        if (shift == kZeroShift || (dimension == 2 && sz != 0)) continue;
        const Vec4 p = points[static_cast<std::size_t>(i)];
        if (within(p.x + sx * period.x, s.min.x, s.max.x) && within(p.y + sy * period.y, s.min.y, s.max.y) &&
            within(p.z + sz * period.z, s.min.z, s.max.z))
          expected.emplace(i, shift);
      }
    CHECK(found == expected);
  }
}

TEST_CASE("sides that are not periodic have no ghosts") {
  Space s = periodic_space(3);
  for (const Side side : {kXMin, kXMax, kZMin, kZMax}) s.boundary[side] = Boundary::wall;
  const std::vector<Ghost> ghosts = ghosts_of(s, {{0.01, 0.01, 0.01, 0.05}});
  REQUIRE(ghosts.size() == 1);
  CHECK(ghosts[0].shift == Vec3{0, Subdomain(s).period().y, 0});
  s.boundary.fill(Boundary::open);
  CHECK(ghosts_of(s, {{0.01, 0.01, 0.01, 0.05}}).empty());
}

TEST_CASE("an update copies fields and moves positions by the shift") {
  const Space s = periodic_space(2);
  std::vector<Vec4> position{{0.5, 1, 0, 0.05}, {0.03, 0.02, 0, 0.04}};
  const std::vector<Ghost> ghosts = ghosts_of(s, position);
  REQUIRE(ghosts.size() == 3);
  position.resize(5);
  std::vector<Vec4> field{{1, 2, 3, 4}, {5, 6, 7, 8}, {}, {}, {}};
  Halo halo;
  halo.exchange(Ranks(), {}, Subdomain(s), {position.data(), 2}, kWidth);
  std::vector<Vec4> velocity{{1, 2, 3, 4}, {-5, 6, 7, 8}, {}, {}, {}};
  halo.update(std::span<Vec4>(field), 2);
  halo.update_motion(position, velocity, {}, 2);
  for (std::size_t g = 0; g < 3; ++g) {
    CHECK((field[2 + g].x == 5 && field[2 + g].w == 8));
    CHECK((velocity[2 + g].x == -5 && velocity[2 + g].w == 8));
    CHECK(xyz(position[2 + g]) == xyz(position[1]) + ghosts[g].shift);
    CHECK(position[2 + g].w == 0.04);
  }
}

}  // namespace scree
