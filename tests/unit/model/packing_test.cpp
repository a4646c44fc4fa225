// The probability of a free random position, by which random groups are checked, against positions tried.
#include "model/derived/generators.hpp"
#include "physics/normal_laws.hpp"
#include "physics/plausible.hpp"
#include "physics/random_packing.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;  // of powers and roots

struct Packing {
  PackingBox box;
  std::vector<Real> radius;
  PackingSums sums;
};

// So many radii between `smallest` and 1 that they fill `fraction` of a box `length` wide.
Packing packing(int dimension, Real fraction, Real smallest, Real length) {
  Packing p{{{0, 0, 0}, {length, length, dimension == 3 ? length : 0}, dimension, 0, 100000}, {}, {}};
  RandomNumbers random(3);
  while (p.sums.fraction < fraction) {
    p.radius.push_back(random.uniform(smallest, 1));
    p.sums.add(dimension, p.radius.back(), std::pow(length, -dimension));
  }
  return p;
}

// The fraction of random positions, away from the walls, that are free for a radius among those positioned.
Real tried_chance(const Packing& p, Real radius) {
  constexpr int kTried = 20000;
  RandomNumbers random(7);
  const std::vector<Vec3> positions = random_packing(
      p.box, p.radius, {}, [](Vec3, Real) { return true; }, random);
  REQUIRE(positions.size() == p.radius.size());
  int free = 0;
  for (int n = 0; n < kTried; ++n) {
    const Real low = 4, high = p.box.max.x - 4;
    Vec3 at{random.uniform(low, high), random.uniform(low, high), 0};
    if (p.box.dimension == 3) at.z = random.uniform(low, high);
    bool is_free = true;
    for (std::size_t i = 0; i < positions.size() && is_free; ++i)
      is_free = norm(at - positions[i]) >= radius + p.radius[i];
    free += is_free;
  }
  return static_cast<Real>(free) / kTried;
}

}  // namespace

TEST_CASE("the probability of a free random position") {
  struct Case {
    int dimension;
    Real fraction, smallest, length;
  };
  // The groups are checked with twice the probability. The box is smaller for the centres than for the
  // fraction.
  for (const Case& one :
       {Case{2, 0.3, 1, 120}, Case{2, 0.42, 1, 120}, Case{3, 0.15, 1, 36}, Case{3, 0.22, 1, 36},
        Case{2, 0.4, 0.4, 100}, Case{3, 0.22, 0.5, 32}, Case{3, 0.3, 0.2, 20}}) {
    CAPTURE(one.dimension, one.fraction, one.smallest);
    const Packing p = packing(one.dimension, one.fraction, one.smallest, one.length);
    const Real tried = tried_chance(p, one.smallest),
               estimated = insertion_probability(one.dimension, p.sums, one.smallest);
    CAPTURE(tried, estimated);
    CHECK(tried < 2 * estimated);
    CHECK(tried > 0.4 * estimated);
  }
  CHECK(insertion_probability(2, 0) == 1);
  CHECK(insertion_probability(2, 0.55) == 0);
  CHECK(insertion_probability(3, 0.39) == 0);
}

TEST_CASE("overlaps at rest and at impact") {
  const NormalLawParameters linear{1e4, 0, 1, false}, hertz{1e6, 0, 1.5, false};
  CHECK(near(static_overlap(linear, 10), 1e-3, {.relative = kRoundOff}));
  CHECK(near(1e6 * std::pow(static_overlap(hertz, 10), 1.5), 10, {.relative = kRoundOff}));
  CHECK(near(impact_overlap(linear, 1, 2), 2 / std::sqrt(1e4), {.relative = kRoundOff}));
  CHECK(near(PowerLaw(hertz).energy(impact_overlap(hertz, 3, 2)), 0.5 * 3 * 4, {.relative = kRoundOff}));
  CHECK(near(damping_ratio(2 * std::sqrt(1e4 * 0.5), 1e4, 0.5), 1, {.relative = kRoundOff}));
  CHECK(near(fall_speed(9.8, 2), std::sqrt(2 * 9.8 * 2), {.relative = kRoundOff}));
  CHECK(near(radius_of_gyration(0.005, 1), std::sqrt(0.005), {.relative = kRoundOff}));
}

}  // namespace scree
