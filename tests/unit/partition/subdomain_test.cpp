// Shifts by periods are exact; points inside or beyond a wall.
#include "partition/subdomain.hpp"

#include <cmath>
#include <limits>

#include "model/derived/random.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

Space space_of(int dimension, Vec3 min, Vec3 max, Boundary boundary) {
  Space space;
  space.dimension = dimension;
  space.min = min, space.max = max;
  space.boundary.fill(boundary);
  return space;
}

// Boxes whose lengths are not representable.
const Space kPeriodic[] = {space_of(3, {0, 0, 0}, {0.3, 0.7, 1.1}, Boundary::periodic),
                           space_of(3, {-0.1, -3.3, 100.1}, {0.2, 5.7, 100.8}, Boundary::periodic),
                           space_of(2, {-1.7, 0.1, 0}, {0.9, 0.4, 0}, Boundary::periodic)};

Vec3 point_in(RandomNumbers& random, const Space& s) {
  const Real x = random.uniform(s.min.x, s.max.x), y = random.uniform(s.min.y, s.max.y);
  return {x, y, s.dimension == 3 ? random.uniform(s.min.z, s.max.z) : 0};
}

Vec3 times(const ImageCount& image, Vec3 period) {
  return {image.x * period.x, image.y * period.y, image.z * period.z};
}

}  // namespace

TEST_CASE("the period is the box's length to a few quanta; other axes have none") {
  for (const Space& s : kPeriodic) {
    const Vec3 period = Subdomain(s).period();
    const Real largest = std::max(norm(s.min), norm(s.max));
    const Real round_off = 8 * 0x1p-50 * largest;
    CHECK(std::abs(period.x - (s.max.x - s.min.x)) <= round_off);
    CHECK(std::abs(period.y - (s.max.y - s.min.y)) <= round_off);
    if (s.dimension == 2) CHECK(period.z == 0);
  }
  const Subdomain open(space_of(3, {0, 0, 0}, {1, 1, 1}, Boundary::open));
  CHECK(open.period() == Vec3{});
  CHECK(snap({0.1, 0.2, 0.3}, open.snap_constant()) == Vec3{0.1, 0.2, 0.3});
}

TEST_CASE("a point moved out by periods is wrapped back to the same bits and counted") {
  RandomNumbers random(1);
  for (const Space& s : kPeriodic) {
    const Subdomain subdomain(s);
    const Vec3 period = subdomain.period();
    for (int trial = 0; trial < 200; ++trial) {
      ImageCount none;
      const Vec3 p = subdomain.wrap(snap(point_in(random, s), subdomain.snap_constant()), none);
      for (const ImageCount moved :
           {ImageCount{1, 0, 0}, ImageCount{-1, 1, 0}, ImageCount{1, -1, s.dimension == 3}}) {
        ImageCount image;
        CHECK(subdomain.wrap(p + times(moved, period), image) == p);
        CHECK((image.x == moved.x && image.y == moved.y && image.z == moved.z));
      }
    }
  }
}

TEST_CASE("a particle's position is sound unless it is not finite or crossed the periodic space at once") {
  for (const Space& s : kPeriodic) {
    const Subdomain subdomain(s);
    const Vec3 period = subdomain.period();
    const Real infinity = std::numeric_limits<Real>::infinity();
    for (Real Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      if (s.dimension == 2 && axis == &Vec3::z) continue;
      const auto sound = [&](Real moved, bool drifts) {
        Vec3 p = s.min + 0.25 * period;
        p.*axis += moved;
        const Vec3 start = p;
        ImageCount image{3, -5, 7};  // counts continue from their values
        const bool sound = wrap_if_sound(s.min, period, drifts, p, image);
        // A ballistic particle keeps its coordinates, also over a restart.
        if (drifts && sound) CHECK((p == start && image.x == 3 && image.y == -5 && image.z == 7));
        return sound;
      };
      for (const Real periods : {-1.0, -0.5, 0.0, 0.5, 1.5}) CHECK(sound(periods * period.*axis, false));
      for (const Real periods : {-1.5, 2.5, 1e5, -1e5}) {
        CHECK_FALSE(sound(periods * period.*axis, false));
        CHECK(sound(periods * period.*axis, true));
      }
      for (const Real moved : {1e20, -1e305, infinity, std::nan("")}) {
        CHECK_FALSE(sound(moved, false));
        CHECK(sound(moved, true) == std::isfinite(moved));
      }
    }
  }
  // A side need not be a multiple of the quantum: a point on it may be outside by round-off.
  for (const Real side : {0.17, 0.1, 0.3, 1e-3}) {
    const Subdomain uneven(space_of(2, {side, 0, 0}, {1, 1, 0}, Boundary::periodic));
    for (const Real x : {side, 1.0}) {
      ImageCount image;
      Vec3 p = snap({x, 0.5, 0}, uneven.snap_constant());
      CHECK(wrap_if_sound({side, 0, 0}, uneven.period(), false, p, image));
    }
  }
  const Space open = space_of(3, {0, 0, 0}, {1, 1, 1}, Boundary::open);
  ImageCount none;
  Vec3 far{1e305, 0.5, 0.5}, nowhere{0.5, std::nan(""), 0.5};
  CHECK(wrap_if_sound(open.min, Subdomain(open).period(), false, far, none));
  CHECK_FALSE(wrap_if_sound(open.min, Subdomain(open).period(), false, nowhere, none));
}

TEST_CASE("a wrapped point lies inside the box") {
  RandomNumbers random(2);
  for (const Space& s : kPeriodic) {
    const Subdomain subdomain(s);
    const Vec3 period = subdomain.period();
    for (int trial = 0; trial < 200; ++trial) {
      ImageCount image;
      const Vec3 shift = random.uniform(-3, 3) * period;
      const Vec3 outside = snap(point_in(random, s) + shift, subdomain.snap_constant());
      const Vec3 p = subdomain.wrap(outside, image);
      CHECK((p.x >= s.min.x && p.x < s.min.x + period.x));
      CHECK((p.y >= s.min.y && p.y < s.min.y + period.y));
      CHECK(norm(p + times(image, period) - outside) == 0);
    }
  }
}

// A point and its image with equal motions: the paths stay a period apart to the bit.
TEST_CASE("snapped displacements add up to the same bits wherever the path is wrapped") {
  RandomNumbers random(3);
  for (const Space& s : kPeriodic) {
    const Subdomain subdomain(s);
    const Vec3 constant = subdomain.snap_constant(), period = subdomain.period();
    ImageCount always, late;
    Vec3 wrapped = subdomain.wrap(snap(point_in(random, s), constant), always), path = wrapped;
    always = {};
    for (int step = 0; step < 500; ++step) {
      const Vec3 dx = random.uniform(-0.05, 0.05) * period;
      wrapped = subdomain.wrap(wrapped + snap(dx, constant), always);
      path += snap(dx, constant);
      if (step % 7 == 0) path = subdomain.wrap(path, late);
    }
    CHECK(subdomain.wrap(path, late) == wrapped);
    CHECK((always.x == late.x && always.y == late.y && always.z == late.z));
  }
}

TEST_CASE("snapping changes a displacement by half a quantum at most") {
  RandomNumbers random(4);
  for (const Space& s : kPeriodic) {
    const Vec3 constant = Subdomain(s).snap_constant();
    for (int trial = 0; trial < 100; ++trial) {
      const Vec3 dx{random.uniform(-1e-3, 1e-3), random.uniform(-1e-6, 1e-6), random.uniform(-1, 1)};
      const Vec3 once = snap(dx, constant);
      CHECK(norm(once - dx) <= 0x1p-52 * norm(constant));
      CHECK(snap(once, constant) == once);
    }
  }
}

TEST_CASE("points are inside between sides that are not periodic, and beyond walls past them") {
  Space s = space_of(3, {0, 0, 0}, {1, 1, 1}, Boundary::open);
  s.boundary[kYMin] = Boundary::wall;
  s.boundary[kZMin] = s.boundary[kZMax] = Boundary::periodic;
  const Subdomain subdomain(s);
  struct Place {
    Vec3 p;
    bool inside, is_beyond_wall;
  };
  for (const Place& place :
       {Place{{0.5, 0.5, 0.5}, true, false}, Place{{0, 0, 0}, true, false},
        Place{{-0.1, 0.5, 0.5}, false, false}, Place{{1.1, 0.5, 0.5}, false, false},
        Place{{0.5, -0.1, 0.5}, false, true}, Place{{0.5, 1.1, 0.5}, false, false},
        Place{{0.5, 0.5, 7}, true, false}, Place{{std::nan(""), 0.5, 0.5}, false, false}}) {
    CAPTURE(place.p.x, place.p.y, place.p.z);
    CHECK(subdomain.inside(place.p) == place.inside);
    CHECK(subdomain.is_beyond_wall(place.p) == place.is_beyond_wall);
  }
  s.dimension = 2, s.min.z = s.max.z = 0;
  CHECK(Subdomain(s).inside({0.5, 0.5, 0}));
}

}  // namespace scree
