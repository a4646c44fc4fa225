// The comparers see every bit of every field.
#include <array>
#include <limits>
#include <vector>

#include "run/state/state.hpp"
#include "support/catch.hpp"
#include "support/state_bits.hpp"

namespace scree {

namespace {

constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();

// Whether a change of a value that had the bits of `value` is detected.
template <class Value, class Change>
bool sees(const Value& value, const Change& change) {
  Value changed = value;
  change(changed);
  return same_bits(value, value) && !same_bits(value, changed) && !same_bits(changed, value);
}

}  // namespace

TEST_CASE("numbers and vectors are the same only in all bits, the sign of zero among them") {
  CHECK(same_bits(0.1, 0.1));
  CHECK_FALSE(same_bits(0.0, -0.0));
  CHECK_FALSE(same_bits(1.0, 1 + std::numeric_limits<Real>::epsilon()));
  CHECK(same_bits(kNaN, kNaN));
  CHECK_FALSE(same_bits(kNaN, -kNaN));
  for (Real Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
    CHECK(sees(Vec3{}, [&](Vec3& v) { v.*axis = -0.0; }));
}

TEST_CASE("ranges are the same in length and all elements") {
  const std::vector<Real> values{0, 1, 2};
  CHECK(same_bits(values, {0, 1, 2}));
  CHECK(same_bits(std::vector<Real>{}, {}));
  CHECK_FALSE(same_bits(values, {0, 1}));
  CHECK_FALSE(same_bits(values, {-0.0, 1, 2}));
  CHECK_FALSE(same_bits(values, {0, 1, 3}));
  CHECK_FALSE(same_bits(std::vector<std::int64_t>{7}, {8}));
  CHECK_FALSE(same_bits(std::array<Real, 2>{0, 0}, std::array<Real, 2>{0, -0.0}));
}

TEST_CASE("every field of particles, wrenches, sums and losses counts") {
  CHECK(sees(std::vector<Particle>(3), [](auto& all) { all[2].force.x = -0.0; }));  // more in unit/dem
  CHECK(sees(std::vector<Particle>(3), [](auto& all) { all.pop_back(); }));
  for (Real ShapeLosses::*loss :
       {&ShapeLosses::contact_loss, &ShapeLosses::loss_power, &ShapeLosses::integrator_loss})
    CHECK(sees(ShapeLosses{}, [&](ShapeLosses& l) { l.*loss = -0.0; }));
  CHECK(sees(BodyWrench{}, [](BodyWrench& w) { w.force.y = -0.0; }));
  CHECK(sees(BodyWrench{}, [](BodyWrench& w) { w.torque.x = -0.0; }));
  CHECK(sees(ContactSum{}, [](ContactSum& s) { s.contacts = 1; }));
  const ContactWrenches wrenches{std::vector<BodyWrench>(2), std::vector<WrenchStiffness>(2)};
  CHECK(sees(wrenches, [](ContactWrenches& w) { w.wrench[1].force.x = -0.0; }));
  CHECK(sees(wrenches, [](ContactWrenches& w) { w.stiffness[1].body = 1; }));
  CHECK(sees(wrenches, [](ContactWrenches& w) { w.stiffness[0].stiffness[20] = -0.0; }));
  CHECK(sees(wrenches, [](ContactWrenches& w) { w.stiffness[0].damping[0] = -0.0; }));
}

TEST_CASE("states that differ name the arrays that do") {
  State state;
  state.particles.resize(2), state.particles[1].global_id = 1;
  state.bodies.velocity = {0, 0};
  const auto differing = [&](const std::function<void(State&)>& change) {
    State other = state;
    change(other);
    return differing_arrays(pack(state), pack(other));
  };
  CHECK(differing([](State&) {}).empty());
  CHECK(differing([](State& s) { s.bodies.velocity[1] = -0.0; }) == "bodies/velocity ");
  CHECK(differing([](State& s) { s.balance.last.kinetic = -0.0; }) == "balance/kinetic ");
  CHECK(differing([](State& s) { ++s.counts.steps; }) == "counts/steps ");
  CHECK(differing([](State& s) { s.particles[1].loss_power = -0.0; }) == "particles/loss_power ");
  CHECK(differing([](State& s) { s.particles[0].drifting = true; }) == "particles/drifting ");
  CHECK(differing([](State& s) { s.particles.pop_back(); }).find("particles/global_id ") !=
        std::string::npos);
  Checkpoint extra = pack(state);
  extra.reals["more"] = {};
  CHECK(differing_arrays(pack(state), extra) == "(other arrays)");
  CHECK(differing_arrays(extra, pack(state)) == "more (other arrays)");
}

}  // namespace scree
