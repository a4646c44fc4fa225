// The state returns from its packed form bit for bit, and says what is missing.
#include "run/state.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.hpp"
#include "support/catch.hpp"
#include "support/checkpoint_arrays.hpp"
#include "support/decks.hpp"

namespace scree {

namespace {

// Numbers that decimal text or a cast would spoil.
class AwkwardNumbers {
 public:
  Real real() {
    static const Real kSpecial[] = {0.1, -0.0, std::numeric_limits<Real>::denorm_min(), 1e308, 1.0 / 3};
    ++count_;
    return count_ % 4 == 0 ? kSpecial[static_cast<std::size_t>(count_ / 4 % 5)] : std::sin(count_) * 1e-7;
  }
  std::int64_t integer() { return (std::int64_t{1} << 53) + 1 + ++count_; }
  std::int32_t small_integer() { return 17 - ++count_; }
  Vec3 vector() {
    const Real x = real(), y = real(), z = real();
    return {x, y, z};
  }

 private:
  int count_ = 0;
};

State awkward_state() {
  AwkwardNumbers n;
  State s;
  s.clock = {n.real(),    n.real(), n.real(), n.integer(), n.integer(), n.integer(),
             n.integer(), n.real(), true,     n.integer(), n.integer(), n.integer()};
  s.counts = {n.integer(), n.integer(), n.integer(), n.integer(), n.integer()};
  for (std::vector<Real>* v : {&s.bodies.position, &s.bodies.velocity, &s.bodies.acceleration,
                               &s.bodies.multipliers, &s.bodies.force, &s.bodies.applied})
    for (int k = 0; k < 6; ++k) v->push_back(n.real());
  for (int b = 0; b < 2; ++b) s.bodies.wrench.push_back({n.vector(), n.vector()});
  s.bodies.dissipated = n.real(), s.bodies.integrator_loss = n.real(), s.bodies.driver_work = n.real();
  for (int i = 0; i < 9; ++i)
    s.particles.push_back({n.integer(),
                           n.vector(),
                           n.vector(),
                           n.vector(),
                           n.vector(),
                           n.real(),
                           n.real(),
                           n.real(),
                           {n.small_integer(), n.small_integer(), n.small_integer()},
                           i % 3 == 0});
  s.shapes = {n.real(), n.real()};
  s.carried_out = {n.integer(), n.integer(), n.real(), n.real(), n.real()};
  s.balance.open = true, s.balance.start = n.real(), s.balance.exchanged = n.real();
  s.balance.last = {n.real(), n.real(), n.real(), n.real(), n.real(), n.real(), n.real(), n.real(), n.real()};
  s.history_rows = n.integer(), s.snapshots = n.integer();
  return s;
}

bool same_bits(const std::vector<Real>& a, const std::vector<Real>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0);
}

std::string unpack_error(const Checkpoint& checkpoint) {
  try {
    unpack(checkpoint);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the state returns from its packed form bit for bit") {
  const State state = awkward_state();
  const State returned = unpack(pack(state));
  const Checkpoint first = with_rows_as_arrays(pack(state)), second = with_rows_as_arrays(pack(returned));
  CHECK(first.integers.at("particles/integers").size() == 5 * state.particles.size());
  CHECK(first.integers == second.integers);
  REQUIRE(first.reals.size() == second.reals.size());
  for (const auto& [name, values] : first.reals) {
    CAPTURE(name);
    CHECK(same_bits(values, second.real_array(name)));
  }
}

TEST_CASE("what a checkpoint holds is the state") {
  const State before = awkward_state();
  const State after = unpack(pack(before));
  CHECK(after.clock.time == before.clock.time);
  CHECK(after.clock.level == before.clock.level);
  CHECK(after.clock.just_rejected);
  CHECK(after.counts.rejected_newton == before.counts.rejected_newton);
  CHECK(same_bits(after.bodies.multipliers, before.bodies.multipliers));
  CHECK(after.bodies.driver_work == before.bodies.driver_work);
  REQUIRE(after.particles.size() == before.particles.size());
  for (std::size_t i = 0; i < after.particles.size(); ++i) {
    const ParticleRecord &a = after.particles[i], &b = before.particles[i];
    CHECK((a.global_id == b.global_id && a.position == b.position && a.velocity == b.velocity));
    CHECK((a.acceleration == b.acceleration && a.force == b.force && a.drifting == b.drifting));
    CHECK((a.contact_loss == b.contact_loss && a.loss_power == b.loss_power));
    CHECK((a.integrator_loss == b.integrator_loss && a.image.x == b.image.x && a.image.z == b.image.z));
  }
  CHECK(after.shapes.loss_power == before.shapes.loss_power);
  CHECK(after.carried_out.removed == before.carried_out.removed);
  CHECK(after.balance.open);
  CHECK(after.balance.last.entries() == before.balance.last.entries());
  CHECK(after.snapshots == before.snapshots);
}

TEST_CASE("the hash is of what was computed, not of what was written") {
  const State state = awkward_state();
  State other = state;
  ++other.history_rows, ++other.snapshots, ++other.clock.snapshots;
  CHECK(state_hash(other, true) == state_hash(state, true));
  other.particles[3].image.y += 1;
  CHECK(state_hash(other, true) != state_hash(state, true));
  other = state, ++other.counts.steps;
  CHECK(state_hash(other, true) != state_hash(state, true));
}

TEST_CASE("a checkpoint that lacks an entry or whose arrays do not fit names it") {
  const State state = awkward_state();
  const Checkpoint whole = pack(state);
  for (const auto& [name, values] : whole.reals) {
    Checkpoint partial = whole;
    partial.path = "some.h5";
    partial.reals.erase(name);
    CHECK(contains(unpack_error(partial), "some.h5"));
    CHECK(contains(unpack_error(partial), name));
  }
  Checkpoint torn = whole;
  --torn.real_rows["particles/reals"].count;
  CHECK(contains(unpack_error(torn), "do not fit together"));
  Checkpoint without = whole;
  without.integer_rows.clear();
  CHECK(contains(unpack_error(without), "particles/integers"));
  Checkpoint doubled = whole;
  doubled.integers["counts/steps"].push_back(1);
  CHECK(contains(unpack_error(doubled), "counts/steps"));
}

}  // namespace scree
