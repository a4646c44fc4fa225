// The Newton matrix of contacts that rub: its blocks against its products, its bounds, the blocks' inverse.
#include "dem/rubbing_matrix.hpp"

#include "model/random.hpp"
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

// One that sticks, or slides; the same seen from j has the opposite normal and direction.
RubbingEntry entry_of(Vec3 n, Vec3 t, Real along, Real across) {
  const auto single = [](Real x) { return static_cast<float>(x); };
  return {{single(n.x), single(n.y), single(n.z), 1},
          {single(t.x), single(t.y), single(t.z), single(along)},
          {single(across), 0}};
}

struct RandomEntry {
  RubbingEntry from_i, from_j;
};

RandomEntry random_entry(RandomNumbers& random, bool slides) {
  Vec3 n = vector(random), t = vector(random);
  n = (1 / norm(n)) * n;
  t = t - dot(n, t) * n;
  t = slides ? (1 / norm(t)) * t : Vec3{};
  const Real along = random.uniform(0.1, 3), across = random.uniform(0.1, 3);
  return {entry_of(n, t, along, across), entry_of(-n, -t, along, across)};
}

Twist product(const Block6& a, Twist v) {
  return {a.move * v.move + a.mixed * v.turn, transposed_times(a.mixed, v.move) + a.turn * v.turn};
}

}  // namespace

TEST_CASE("a contact's block is what it does to its own particle") {
  RandomNumbers random(3);
  for (int k = 0; k < 200; ++k) {
    const RubbingEntry entry = random_entry(random, k % 2 == 0).from_i;
    const Twist v{vector(random), vector(random)};
    Block6 block;
    entry.add_to(block);
    const Twist expected = entry.pull(v.move, v.turn, false), found = product(block, v);
    CHECK(near(found.move, expected.move, {.absolute = 20 * kSingle}));
    CHECK(near(found.turn, expected.turn, {.absolute = 20 * kSingle}));
  }
}

TEST_CASE("a contact's matrix is positive, and no larger than twice its diagonal blocks") {
  RandomNumbers random(4);
  for (int k = 0; k < 1000; ++k) {
    const RandomEntry pair = random_entry(random, k % 2 == 0);
    const Twist i{vector(random), vector(random)}, j{vector(random), vector(random)};
    const Vec3 turning = i.turn + j.turn;
    const Twist on_i = pair.from_i.pull(i.move - j.move, turning, false),
                on_j = pair.from_j.pull(j.move - i.move, turning, false);
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
    const Twist back = Block6f::inverse_of(block) * product(block, v);
    CHECK(near(back.move, v.move, {.absolute = 300 * kSingle}));
    CHECK(near(back.turn, v.turn, {.absolute = 300 * kSingle}));
  }
}

}  // namespace scree
