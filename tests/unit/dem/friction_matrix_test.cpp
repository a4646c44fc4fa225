// The Newton matrix of frictional contacts: its products against differences of forces, its blocks against
// its products, its bounds, and the blocks' inverses.
#include "dem/implicit/friction_matrix.hpp"

#include "dem/implicit/friction_items.hpp"
#include "model/derived/random.hpp"
#include "physics/normal_laws.hpp"
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

// Two spheres of radius 1 over a step of 1 s, without damping; i is displaced and rotated by small amounts.
struct Pair {
  ContactLaw<LinearLaw, LinearSlider> law;
  Vec3 r0, r1, spin;      // vectors from j to i at the start and the end; rotation of i over the step
  ContactHistory before;  // across the normal at the start

  FrictionalContact moved(const Twist& by) const {
    const PairSize size{1, 1, 1, 1};
    const ContactGeometry begin = sphere_pair(r0, Real(2)), end = sphere_pair(r1 + by.move, Real(2));
    const Vec3 displacement = r1 + by.move - r0;
    FrictionalPath path{};
    static_cast<ContactPath&>(path) = OverImplicitStep{{nullptr, nullptr, 1, true}}.path(
        end, displacement, begin, displacement, displacement, size);
    path.motion = sphere_motion(end, displacement, {spin + by.turn, 1, Real(0.4)}, {{}, 1, Real(0.4)}, 1);
    path.lever_arm_ratio0 = 2 / begin.distance, path.curvature = end.scale;
    return frictional_contact(law, path, before, true, [](bool) { return Vec3{}; });
  }
  // Force and torque on i.
  Twist load(const Twist& by) const {
    const FrictionalContact c = moved(by);
    const FrictionSums sums = FrictionSums::of(c);
    return {sums.step_force, sums.step_moment};
  }
};

// Overlaps at both ends, one of which may be negative, of the order of `size`, as are slip and spring.
Pair random_pair(RandomNumbers& random, Real size, Real friction) {
  Pair out{{LinearLaw(2, 0, false), {Real(0.7), friction, 0}}, {}, {}, {}, {}};
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
      const Pair pair = random_pair(random, of.size, of.friction);
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
