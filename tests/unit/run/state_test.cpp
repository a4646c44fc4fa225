// The state returns from its packed form bit for bit, and missing parts are reported.
#include "run/state/state.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "output/hdf5_file.hpp"
#include "support/catch.hpp"
#include "support/decks.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"

namespace scree {

namespace {

// Numbers that decimal text or a cast would change.
class AwkwardNumbers {
 public:
  Real real() {
    static const Real kSpecial[] = {0.1, -0.0, std::numeric_limits<Real>::denorm_min(), 1e308, 1.0 / 3};
    ++count_;
    return count_ % 4 == 0 ? kSpecial[static_cast<std::size_t>(count_ / 4 % 5)] : std::sin(count_) * 1e-7;
  }
  std::int64_t integer() { return (std::int64_t{1} << 53) + 1 + ++count_; }
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
  for (int i = 0; i < 9; ++i) {
    s.particles.emplace_back().global_id = n.integer();
    fill_fields(s.particles.back(), i);
  }
  s.there = {true, true};
  s.shapes = {n.real(), n.real(), n.real(), {{n.real(), 0, n.real()}}};
  s.shape_contacts = {HistoryContent::of_law(3), {0, 2, 2}, {n.integer(), n.integer(), n.integer() + 1}, {}};
  for (int k = 0; k < 9; ++k) s.shape_contacts.values.push_back(n.real());
  for (int k = 0; k < 30; ++k) s.works.push_back(k % 2 == 0 ? n.integer() : -n.integer());
  s.carried_out = {n.integer(), n.integer(), n.real(), n.real(), n.real(), {{n.real(), n.real(), n.real()}},
                   n.real(),    n.real()};
  s.bodies.min_kinetic = n.real(), s.bodies.max_kinetic = n.real();
  s.balance = {true, n.real(), n.real(), n.real(), n.real(), {}, {}};
  s.balance.extremes = {n.real(), n.real(), n.real(), n.real(), n.real()};
  s.balance.last = {n.real(), n.real(), n.real(), n.real(), n.real(), n.real(), n.real(), n.real(), n.real()};
  s.history_rows = n.integer(), s.snapshots = n.integer();
  return s;
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
  CHECK(pack(state).integer_rows.at("particles/image").count == std::ssize(state.particles));
  CHECK(differing_arrays(pack(state), pack(returned)) == "");
}

TEST_CASE("a checkpoint contains the state") {
  const State before = awkward_state();
  const State after = unpack(pack(before));
  CHECK(same_bits(after.clock.time, before.clock.time));
  CHECK(after.clock.level == before.clock.level);
  CHECK(after.clock.just_rejected);
  CHECK(after.counts.rejected_newton == before.counts.rejected_newton);
  CHECK(same_bits(after.bodies.multipliers, before.bodies.multipliers));
  CHECK(same_bits(after.bodies.driver_work, before.bodies.driver_work));
  CHECK(differing_fields(after.particles, before.particles) == "");
  CHECK(same_bits(after.shapes.loss_power, before.shapes.loss_power));
  CHECK(after.shapes.tangential == before.shapes.tangential);
  CHECK(after.shape_contacts == before.shape_contacts);
  CHECK(after.works == before.works);
  CHECK(after.carried_out.removed == before.carried_out.removed);
  CHECK(after.balance.open);
  CHECK(same_bits(after.balance.last.entries(), before.balance.last.entries()));
  CHECK(same_bits(after.balance.extremes.min_work, before.balance.extremes.min_work));
  CHECK(after.snapshots == before.snapshots);
}

TEST_CASE("the hash is of what was computed, not of what was written") {
  const State state = awkward_state();
  State other = state;
  ++other.history_rows, ++other.snapshots, ++other.clock.snapshots;
  CHECK(state_hash(other, true) == state_hash(state, true));
  ++other.counts.steps;
  CHECK(state_hash(other, true) != state_hash(state, true));
}

TEST_CASE("works of triangles are hashed where there are some, and are otherwise no part of a checkpoint") {
  const State state = awkward_state();
  State other = state;
  ++other.works[7];
  CHECK(state_hash(other, true) != state_hash(state, true));
  other.works.clear();
  CHECK(!pack(other).integers.contains(kWorksName));
  CHECK(unpack(pack(other)).works.empty());
}

TEST_CASE(
    "histories and losses of shapes' contacts are hashed where there are some, and otherwise not stored") {
  const State state = awkward_state();
  State other = state;
  other.shape_contacts.values[4] += 1;
  CHECK(state_hash(other, true) != state_hash(state, true));
  other = state, ++other.shape_contacts.keys[2];
  CHECK(state_hash(other, true) != state_hash(state, true));
  other = state, other.shapes.tangential.of[kRollingLoss] = 1;
  CHECK(state_hash(other, true) != state_hash(state, true));
  other.shapes.tangential = {}, other.shape_contacts = {};
  for (const char* name : {kShapeFrictionLosses, kShapeHistory}) CHECK(!pack(other).reals.contains(name));
  for (const char* name : {kShapeContactsOf, kShapeContactsWith}) CHECK(!pack(other).integers.contains(name));
  CHECK(unpack(pack(other)).shape_contacts == ShapeContacts{});
  other = state, std::swap(other.shape_contacts.shapes[0], other.shape_contacts.shapes[1]);
  CHECK(contains(unpack_error(pack(other)), "out of order"));
}

TEST_CASE("the hash is of every field that changes in time, and of no other") {
  const State state = awkward_state();
  for_each_field([&](const ParticleField& field, auto member) {
    CAPTURE(field.name);
    for (std::size_t k = 0; k < numbers_of(state.particles[3].*member).size(); ++k) {
      State other = state;
      auto numbers = numbers_of(state.particles[3].*member);
      numbers[k] += 1;
      set_value(other.particles[3].*member, numbers.data());
      const bool differs = state_hash(other, true) != state_hash(state, true);
      CHECK(differs == ((field.parts & kState) != 0));
    }
  });
}

TEST_CASE("angles of spatial joints have a dataset of their own, and their revolutions are hashed") {
  State state = awkward_state();
  const State without = state;
  state.bodies.counted_angles = 2;
  for (const Real angle : {0.5, -3.1}) state.bodies.position.push_back(angle);
  const Checkpoint packed = pack(state);
  CHECK(packed.reals.at("bodies/position").size() == without.bodies.position.size());
  CHECK(packed.reals.at("bodies/counted_angles") == std::vector<Real>{0.5, -3.1});
  const State returned = unpack(packed);
  CHECK(same_bits(returned.bodies.position, state.bodies.position));
  CHECK(returned.bodies.counted_angles == 2);
  CHECK(pack(without).reals.count("bodies/counted_angles") == 0);
  CHECK(state_hash(state, true) == state_hash(without, true));  // no angle has completed a revolution
  state.bodies.position.back() -= 2 * M_PI;
  const std::uint64_t once = state_hash(state, true);
  CHECK(once != state_hash(without, true));
  state.bodies.position.back() -= 2 * M_PI;
  CHECK(state_hash(state, true) != once);
  state.bodies.position.back() = std::numeric_limits<Real>::infinity();
  CHECK_THROWS_AS(check_state(state, "some.h5", ParticleSet{}, {}), IoError);
}

TEST_CASE("the state of particles that do not rotate has nothing of rotation") {
  State state = awkward_state();
  state.there = {};
  const std::uint64_t hash = state_hash(state, true);
  const Checkpoint checkpoint = pack(state);
  for_each_field([&](const ParticleField& field, auto member) {
    if ((field.parts & kRotation) == 0) return;
    CAPTURE(field.name);
    CHECK(!checkpoint.real_rows.contains(std::string("particles/") + field.name));
    for (Particle& p : state.particles) p.*member = {};
  });
  CHECK(state_hash(state, true) == hash);
  CHECK(!unpack(checkpoint).there.rotates);
  CHECK(differing_fields(unpack(checkpoint).particles, state.particles) == "");
}

TEST_CASE("where particles rotate and nothing resists rolling, the state has nothing of that") {
  State state = awkward_state();
  state.there.rolls = false;
  const Checkpoint checkpoint = pack(state);
  CHECK(checkpoint.real_rows.contains("particles/friction_loss"));
  CHECK(!checkpoint.real_rows.contains("particles/rolling_loss"));
  CHECK(!checkpoint.real_rows.contains("particles/twisting_loss"));
  const FieldsThere there = unpack(checkpoint).there;
  CHECK((there.rotates && !there.rolls));
}

TEST_CASE("a checkpoint holds a dataset for each field, with its unit and what it means") {
  const State state = awkward_state();
  const ScratchDirectory folder;
  write_checkpoint(folder / "c.h5", pack(state));
  CHECK(differing_fields(unpack(read_checkpoint(folder / "c.h5")).particles, state.particles) == "");
  const Hdf5File file(folder / "c.h5", Hdf5Access::read);
  std::size_t datasets =
      file.dataset_names("/real_rows/").size() + file.dataset_names("/integer_rows/").size();
  CHECK(file.rows("/integer_rows/particles/global_id") == 9);
  --datasets;
  for_each_field([&](const ParticleField& field, auto member) {
    auto numbers = numbers_of(state.particles[0].*member);
    const bool real = std::is_same_v<decltype(numbers), std::array<Real, numbers.size()>>;
    const std::string name = std::string(real ? "/real_rows" : "/integer_rows") + "/particles/" + field.name;
    CAPTURE(name);
    CHECK(file.rows(name) == 9);
    CHECK(file.width(name) == std::ssize(numbers));
    CHECK(file.read_text_attribute(name, "unit") == field.unit);
    CHECK(file.read_text_attribute(name, "description") == field.description);
    --datasets;
  });
  CHECK(datasets == 0);
}

TEST_CASE("a number that a field cannot hold is refused by the field's name") {
  const State state = awkward_state();
  for (const char* name : {"particles/image", "particles/drifting", "particles/material"})
    for (const std::int64_t value :
         {std::int64_t{1} << 32, -(std::int64_t{1} << 32), std::int64_t{1} << 40}) {
      CAPTURE(name, value);
      Checkpoint changed = pack(state);
      auto& rows = changed.integer_rows.at(name);
      rows.copy = [copy = rows.copy, value](std::int64_t first, std::int64_t count, std::int64_t* to) {
        copy(first, count, to);
        to[4] = value;
      };
      CHECK(contains(unpack_error(changed), name));
    }
}

TEST_CASE("constants that no particle of the deck has are refused") {
  State state;
  Particle& p = state.particles.emplace_back();
  p.global_id = 7, p.radius = 0.2, p.mass = 3, p.material = 1;
  ParticleTotals deck;
  deck.smallest_radius = 0.1, deck.largest_radius = 0.2, deck.smallest_mass = 3, deck.largest_mass = 4;
  deck.materials.resize(2);
  const auto message = [&]() -> std::string {
    try {
      check_constants(state, "some.h5", deck);
    } catch (const IoError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message() == "");
  for (const auto& [name, member] :
       {std::pair("radius", &Particle::radius), std::pair("mass", &Particle::mass)})
    for (const Real value : {0.0, 0.09, 4.1, std::nan("")}) {
      CAPTURE(name, value);
      const Real healthy = std::exchange(p.*member, value);
      CHECK(contains(message(),
                     "some.h5: not a valid checkpoint: the " + std::string(name) + " of particle 7 is "));
      p.*member = healthy;
    }
  for (const int material : {-1, 2}) {
    p.material = material;
    CHECK(contains(message(), "the material of particle 7 is "));
  }
}

TEST_CASE("a checkpoint that lacks an entry or whose arrays do not fit names it") {
  const State state = awkward_state();
  const Checkpoint whole = pack(state);
  for (const auto& [name, values] : whole.reals) {
    if (name == kShapeFrictionLosses) continue;  // a state without them has no losses
    Checkpoint partial = whole;
    partial.path = "some.h5";
    partial.reals.erase(name);
    CHECK(contains(unpack_error(partial), "some.h5"));
    CHECK(contains(unpack_error(partial), name));
  }
  Checkpoint torn = whole;
  --torn.real_rows["particles/radius"].count;
  CHECK(contains(unpack_error(torn), "do not fit together"));
  Checkpoint without = whole;
  without.integer_rows.clear();
  CHECK(contains(unpack_error(without), "particles/global_id"));
  Checkpoint doubled = whole;
  doubled.integers["counts/steps"].push_back(1);
  CHECK(contains(unpack_error(doubled), "counts/steps"));
}

}  // namespace scree
