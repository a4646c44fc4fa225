// The Newton matrix of frictional contacts: its products against differences of forces, its blocks against
// its products, its bounds, and the blocks' inverses.
#include "dem/implicit/friction_matrix.hpp"

#include "dem/implicit/friction_items.hpp"
#include "model/derived/random.hpp"
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kSingle = 1e-6;  // of entries in single precision

Vec3 vector(RandomNumbers& random) {
  const Real x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

Real dot(Twist a, Twist b) { return scree::dot(a.move, b.move) + scree::dot(a.turn, b.turn); }

Twist pull(const FrictionEntry& entry, Vec3 apart, Vec3 turning, bool consistent) {
  return in_double(entry.apply(in_single(apart), in_single(turning), consistent));
}

// A sticking or sliding contact; seen from j it has the opposite normal and direction.
FrictionEntry entry_of(Vec3 n, Vec3 t, Real along, Real across) {
  const auto single = [](Real x) { return static_cast<float>(x); };
  return {{single(n.x), single(n.y), single(n.z), 1},
          {single(t.x), single(t.y), single(t.z), single(along)},
          {0, 0, 0, single(across)}};
}

struct RandomEntry {
  FrictionEntry from_i, from_j;
};

RandomEntry random_entry(RandomNumbers& random, bool slides) {
  Vec3 n = vector(random), t = vector(random);
  n = (1 / norm(n)) * n;
  t = t - dot(n, t) * n;
  t = slides ? (1 / norm(t)) * t : Vec3{};
  const Real along = random.uniform(0.1, 3), across = random.uniform(0.1, 3);
  return {entry_of(n, t, along, across), entry_of(-n, -t, along, across)};
}

// Spins that no dashpot reads.
struct NoSpins {
  Vec3 arm_sum(bool) const { return {}; }
  Vec3 relative(bool) const { return {}; }
};

// Two spheres of radius 1 over a step of 1 s, without damping; i is displaced and rotated by small amounts.
template <class Law>
struct Pair {
  Law law;
  Vec3 r0, r1, spin;      // vectors from j to i at the start and the end; rotation of i over the step
  ContactHistory before;  // across the normal at the start

  FrictionalContactOf<Law> moved(const Twist& by) const {
    const PairSize size{1, 1, 1, 1};
    const ContactGeometry begin = sphere_pair(r0, Real(2)), end = sphere_pair(r1 + by.move, Real(2));
    const Vec3 displacement = r1 + by.move - r0;
    FrictionalPath path{};
    static_cast<ContactPath&>(path) = OverImplicitStep{{nullptr, nullptr, 1, true}}.path(
        end, displacement, begin, displacement, displacement, size);
    path.motion = sphere_motion(end, displacement, {spin + by.turn, 1, Real(0.4)}, {{}, 1, Real(0.4)}, 1);
    path.lever_arm_ratio0 = 2 / begin.distance, path.curvature = end.scale;
    return frictional_contact<false>(law, path, before, true, NoSpins{});
  }
  // Force and torque on i.
  Twist load(const Twist& by) const {
    const FrictionalContactOf<Law> c = moved(by);
    const FrictionSums sums = FrictionSums::of(c);
    return {sums.step_force, sums.step_moment};
  }
};

// Overlaps at both ends, one of which may be negative, of the order of `size`, as are slip and spring.
template <class Law>
Pair<Law> random_pair(RandomNumbers& random, Real size, Real friction, const Law& law) {
  Pair<Law> out{law, {}, {}, {}, {}};
  Vec3 n = vector(random);
  n = (1 / norm(n)) * n;
  const Real overlap0 = size * random.uniform(-1, 1),
             overlap1 = overlap0 > 0 ? size * random.uniform(-1, 1) : size * random.uniform();
  out.r0 = (2 - overlap0) * n;
  const Vec3 r1 = n + size * vector(random);
  out.r1 = ((2 - overlap1) / norm(r1)) * r1, out.spin = size * vector(random);
  if (overlap0 > 0)
    out.before.spring = shortened(size * tangential_part(vector(random), n), 2 * friction * overlap0);
  return out;
}

Twist product(const Block6& a, Twist v) {
  return {a.move * v.move + a.mixed * v.turn, transposed_times(a.mixed, v.move) + a.turn * v.turn};
}

}  // namespace

TEST_CASE("a contact's matrix is the derivative of its force") {
  struct Case {
    Real size, friction,
        error;  // size of the overlap; without friction only the normal force rotates, at any overlap
  };
  RandomNumbers random(2);
  for (const Case& of : {Case{1e-5, 2, 3e-4}, Case{0.2, 0, 3e-5}}) {
    int opens = 0, slides = 0, looks = 0;
    for (int k = 0; k < 2000; ++k) {
      const ContactLaw<LinearLaw, LinearSlider> law{LinearLaw(2, 0, false), {Real(0.7), of.friction, 0}};
      const Pair pair = random_pair(random, of.size, of.friction, law);
      const Twist way{vector(random), vector(random)};
      const Real little = 1e-5 * of.size;
      const Twist forth = little * way, back = -little * way;
      const FrictionalContact at = pair.moved({}), after = pair.moved(forth), before = pair.moved(back);
      if (!at.acts || (after.friction.normal_force_slope > 0) != (before.friction.normal_force_slope > 0) ||
          after.lasts != before.lasts)
        continue;  // a kink
      const Twist change = (1 / (2 * little)) * (pair.load(forth) - pair.load(back));
      const Twist found = pull(FrictionEntry::of(at, {1, 0}, 1), way.move, way.turn, true);
      REQUIRE(near(found.move, -change.move, {.absolute = of.error}));
      REQUIRE(near(found.turn, -change.turn, {.absolute = of.error}));
      ++looks, opens += at.lasts != (norm(pair.r0) < 2), slides += at.friction.normal_force_slope > 0;
    }
    CAPTURE(looks, opens, slides);
    CHECK((looks > 1500 && opens > looks / 3));
    if (of.friction > 0) CHECK((slides > looks / 5 && slides < 4 * looks / 5));
  }
}

// The moment is of the size of the torque of friction. Where the contact opens or closes, the share of the
// step in contact is not differentiated.
TEST_CASE("the matrix of a contact with rolling resistance is the derivative of its force and moment") {
  constexpr Real kSize = 1e-5, kFriction = 2, kError = 1e-3;
  ContactLaw<LinearRestitutionLaw, LinearSlider, AnyRolling> law;
  law.normal.normal_stiffness = 2, law.tangential = {Real(0.7), kFriction, 0};
  RandomNumbers random(7);
  int looks = 0, rolls = 0, twists = 0;
  for (int k = 0; k < 4000; ++k) {
    const Real limit = random.uniform(0.5, 3);
    law.rolling = AnyRolling::of({limit, 0, 0.4, 0, k % 4 == 0 ? 0.1 : 0, k % 2 == 0 ? 1e9 : 0.});
    auto pair = random_pair(random, kSize, kFriction, law);
    // Without a twisting moment, whose stiffness depends on the contact radius.
    const Vec3 n0 = (1 / norm(pair.r0)) * pair.r0, moment = kSize * tangential_part(vector(random), n0);
    pair.before.moment = shortened(moment, limit * std::max(2 - norm(pair.r0), Real(0)));
    const Twist way{vector(random), vector(random)};
    const Real little = 1e-5 * kSize;
    const Twist forth = little * way, back = -little * way;
    const auto at = pair.moved({}), after = pair.moved(forth), before = pair.moved(back);
    const bool lasts = norm(pair.r0) < 2 && after.lasts && before.lasts;
    if (!lasts || (after.friction.normal_force_slope > 0) != (before.friction.normal_force_slope > 0) ||
        (norm(after.rolling.direction) > 0) != (norm(before.rolling.direction) > 0))
      continue;
    if (k % 4 == 0 && at.rolling.rolling_losses.sliding != 0) continue;
    const Twist change = (1 / (2 * little)) * (pair.load(forth) - pair.load(back));
    Twist found = pull(FrictionEntry::of(at, {1, 0}, 1), way.move, way.turn, true);
    const Vec3 n = at.normal.normal;
    found.turn += in_double(
        RollingEntry::of(at, {1, 0}, 1).apply(in_single(n), in_single(way.move), in_single(way.turn), true));
    CAPTURE(k);
    REQUIRE(near(found.move, -change.move, {.absolute = kError}));
    REQUIRE(near(found.turn, -change.turn, {.absolute = kError}));
    ++looks, rolls += norm(at.rolling.direction) > 0, twists += at.rolling.twisting > 0;
  }
  CAPTURE(looks, rolls, twists);
  CHECK((looks > 400 && rolls > looks / 8 && rolls < looks && twists > looks / 4));
}

TEST_CASE("resistance to rolling is positive, and no larger than twice its blocks, for any radii") {
  RandomNumbers random(8);
  for (int k = 0; k < 1000; ++k) {
    Vec3 n = vector(random), t = vector(random);
    n = (1 / norm(n)) * n, t = t - dot(n, t) * n;
    t = k % 2 == 0 ? (1 / norm(t)) * t : Vec3{};
    RollingFrictionalContact c{};
    c.normal.normal = n, c.rolling.direction = t;
    c.rolling.rolling = random.uniform(0.1, 3), c.rolling.twisting = random.uniform(0, 3);
    const Real radius[2] = {random.uniform(0.2, 1), random.uniform(0.2, 1)};
    const Vec3 turn[2] = {vector(random), vector(random)};
    Real size = 0, blocks = 0;
    for (int i = 0; i < 2; ++i) {
      c.radius_i = radius[i], c.radius_j = radius[1 - i];
      const RollingEntry entry = RollingEntry::of(c, {1, 0}, radius[i] / radius[1 - i]);
      const Vec3 relative = turn[i] - radius[i] / radius[1 - i] * turn[1 - i];
      size += dot(turn[i], in_double(entry.apply(in_single(n), Vec3f{}, in_single(relative), false)));
      Block6 block{};
      entry.add_to(block, n);
      blocks += dot(turn[i], block.turn * turn[i]);
    }
    CHECK(size >= -1e-4);
    CHECK(size <= 2 * blocks * (1 + 1e-5) + 1e-4);
  }
}

TEST_CASE("a contact's block is what it does to its own particle") {
  RandomNumbers random(3);
  for (int k = 0; k < 200; ++k) {
    const FrictionEntry entry = random_entry(random, k % 2 == 0).from_i;
    const Twist v{vector(random), vector(random)};
    Block6 block;
    entry.add_to(block);
    const Twist expected = pull(entry, v.move, v.turn, false), found = product(block, v);
    CHECK(near(found.move, expected.move, {.absolute = 20 * kSingle}));
    CHECK(near(found.turn, expected.turn, {.absolute = 20 * kSingle}));
  }
}

TEST_CASE(
    "a body's correction through a contact's matrix is in double precision: accelerations of any size") {
  RandomNumbers random(5);
  const FrictionEntry entry = random_entry(random, true).from_i;
  const Twist v{vector(random), vector(random)}, expected = entry.apply(v.move, v.turn, true);
  for (const Real size : {1e-50, 1e50}) {
    const Twist found = (1 / size) * entry.apply(size * v.move, size * v.turn, true);
    CHECK(near(found.move, expected.move, {.absolute = 1e-14}));
    CHECK(near(found.turn, expected.turn, {.absolute = 1e-14}));
  }
}

TEST_CASE("a contact's matrix is positive, and no larger than twice its diagonal blocks") {
  RandomNumbers random(4);
  for (int k = 0; k < 1000; ++k) {
    const RandomEntry pair = random_entry(random, k % 2 == 0);
    const Twist i{vector(random), vector(random)}, j{vector(random), vector(random)};
    const Vec3 turning = i.turn + j.turn;
    const Twist on_i = pull(pair.from_i, i.move - j.move, turning, false),
                on_j = pull(pair.from_j, j.move - i.move, turning, false);
    CHECK(near(on_j.move, -on_i.move, {.absolute = 20 * kSingle}));
    CHECK(near(on_j.turn, on_i.turn, {.absolute = 20 * kSingle}));
    const Real size = dot(i, on_i) + dot(j, on_j);
    Block6 block_i, block_j;
    pair.from_i.add_to(block_i), pair.from_j.add_to(block_j);
    CHECK(size >= -100 * kSingle);
    CHECK(size <= 2 * (dot(i, product(block_i, i)) + dot(j, product(block_j, j))) + 100 * kSingle);
  }
}

TEST_CASE("blocks are inverted to single precision, and their largest row bounds them") {
  RandomNumbers random(5);
  for (int k = 0; k < 200; ++k) {
    Block6 block;
    for (int contact = 0; contact < 1 + k % 7; ++contact)
      random_entry(random, contact % 2 == 0).from_i.add_to(block);
    const Real mass = random.uniform(0.5, 2), inertia = Real(0.4) * mass;
    const Twist v{vector(random), vector(random)};
    const Real size = mass * dot(v.move, v.move) + inertia * dot(v.turn, v.turn);
    CHECK(dot(v, product(block, v)) <= largest_row(block, mass, inertia) * size);
    block.move += Sym3{mass, 0, 0, mass, 0, mass}, block.turn += Sym3{inertia, 0, 0, inertia, 0, inertia};
    const Twist back = in_double(Block6f::inverse_of(block) * in_single(product(block, v)));
    CHECK(near(back.move, v.move, {.absolute = 300 * kSingle}));
    CHECK(near(back.turn, v.turn, {.absolute = 300 * kSingle}));
  }
}

}  // namespace scree
