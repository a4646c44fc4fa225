// Redundant constraints: refused by name, permitted with minimum-norm reactions, or contradictory.
#include <cmath>
#include <string>
#include <vector>

#include "mbs/hht_method.hpp"
#include "mbs/start_checks.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "unit/mbs/refusals.hpp"

using namespace scree;

TEST_CASE("redundant constraints are named") {
  Model model = closed_chain();
  CHECK(refusal(model) == "nothing was refused");
  SECTION("a joint twice") {
    model.joints.push_back(model.joints[1]);
    model.joints[3].name = "again";
    const std::string text = refusal(model);
    CHECK(contains(text, "redundant"));
    CHECK(contains(text, "joint 'middle', joint 'again'"));
    CHECK(!contains(text, "left"));
  }
  SECTION("a mechanism that is fixed once more") {
    model.joints[2].kind = JointKind::fixed;
    CHECK(contains(refusal(model), "redundant"));
    CHECK(contains(refusal(model), "joint 'left', joint 'middle', joint 'right'"));
  }
  SECTION("two drivers of one joint") {
    model = hanging_disc();
    model.drivers.push_back({"first", 0, {}});
    model.drivers.push_back({"second", 0, {}});
    CHECK(contains(refusal(model), "driver 'first', driver 'second'"));
  }
  SECTION("a joint from ground to ground") {
    model.joints.push_back(ground_pin("nowhere", kGround, {1, 2, 0}, {1, 2, 0}));
    CHECK(contains(refusal(model), "joint 'nowhere'"));
  }
}

TEST_CASE("with minimum-norm reactions constraints may be redundant, but not contradictory") {
  Model model = hanging_disc();
  model.bodies[0].velocity = {0, 1, 0}, model.bodies[0].angular_velocity = 2;
  model.drivers = {{"first", 0, ramp(2)}, {"second", 0, ramp(2)}};
  CHECK(contains(refusal(model),
                 "driver 'first', driver 'second' fix the same motion more than once, 4 rows "
                 "have rank 3; the motion is unique, the reactions of these are not. Remove or "
                 "change one; or set integrator.redundant = \"minimum-norm\" for minimum-norm reactions"));
  CHECK(!contains(refusal(model), "spherical"));
  model.integrator.redundant = RedundantRows::share;
  CHECK(refusal(model) == "nothing was refused");
  petsc();
  Multibody shared(model);
  CHECK(shared.redundancy() == "4 rows of rank 3: driver 'first', driver 'second'");
  const MultibodyState state = shared.initial_state(std::vector<BodyWrench>(1));
  const std::vector<Reaction> reactions = shared.reactions(state, 0);
  for (const std::size_t driver : {1, 2})  // half of the weight's moment about the pivot
    CHECK(near(reactions[driver].torque.z, kGravity * 0.5 / 2, {.relative = 1e-6}));
  const auto contradict = [&](const std::string& what) {
    for (const RedundantRows rows : {RedundantRows::share, RedundantRows::error}) {
      model.integrator.redundant = rows;
      CHECK(contains(refusal(model), "driver 'first', driver 'second' contradict each other: the " + what +
                                         ", and no motion satisfies them all. Change or remove one"));
    }
  };
  SECTION("positions") {
    model.drivers[1].motion.value = 0.1;
    contradict("positions that they require at t = 0 differ by 0.1 rad");
    model.drivers[0].motion.value = 0.1;  // consistent with each other, but not with the bodies' positions
    CHECK(contains(refusal(model),
                   "driver 'first': its motion and the joint's coordinate at t = 0 differ by 0.1 rad"));
  }
  SECTION("velocities") {
    model.drivers[1].motion.rate = 2.5;
    for (const bool consistent : {false, true}) {
      model.consistent_velocities = consistent;
      contradict("velocities that they require at t = 0 differ by 0.5 rad/s");
    }
    model.drivers.push_back({"third", 0, ramp(2)});
    model.drivers.push_back({"fourth", 0, ramp(4)});
    CHECK(contains(refusal(model),
                   "driver 'fourth' contradict each other"));  // named by the largest difference
    CHECK(!contains(refusal(model), "driver 'second'"));
  }
  SECTION("accelerations") {
    TimeFunction& motion = model.drivers[1].motion;
    motion.kind = TimeFunction::Kind::table;
    motion.times = {0, 1, 2}, motion.values = {0, 2.5, 6};
    motion.interpolation = Interpolation::clamped;
    motion.end_rates = {2, 4};
    contradict("accelerations that they require at t = 0 differ by 1 rad/s^2");
  }
  SECTION("later") {
    TimeFunction& motion = model.drivers[1].motion;
    motion.kind = TimeFunction::Kind::sine;
    motion.amplitude = 0.5, motion.frequency = 2 / M_PI;
    model.time.end = 1;
    contradict("velocities that they require at t = 0.005 s differ by 0.000399987 rad/s");
  }
  SECTION("a driver and a joint") {
    model.drivers.pop_back();
    model.joints.push_back(model.joints[0]);
    model.joints[1].kind = JointKind::fixed, model.joints[1].name = "weld";
    model.joints[1].deck_label = "deck.toml:7:1: joints.weld";
    model.drivers[0].deck_label = "deck.toml:9:1: drivers.first";
    CHECK(refusal(model) ==
          "deck.toml:9:1: drivers.first: joint 'weld', driver 'first' contradict each other: the velocities "
          "that they require at t = 0 differ by 2 rad/s, and no motion satisfies them all. Change or remove "
          "one");
  }
  SECTION("that begin to contradict each other on the way") {  // the rows of two joints
    model.drivers.pop_back();
    model.bodies.push_back(paper_disc("twin", 0.5, 0));
    model.bodies[1].velocity = {0, 1, 0}, model.bodies[1].angular_velocity = 2;
    model.joints.push_back(ground_pin("other", 1, {0, 0, 0}, {-0.5, 0, 0}));
    model.joints.push_back(ground_pin("weld", 1, {0.5, 0, 0}, {0, 0, 0}));
    model.joints[2].kind = JointKind::fixed, model.joints[2].body[0] = 0, model.joints[2].point[0] = {};
    model.drivers.push_back({"second", 1, {}});
    model.drivers[1].motion.kind = TimeFunction::Kind::sine;
    model.drivers[1].motion.amplitude = 0.5, model.drivers[1].motion.frequency = 2 / M_PI;
    Multibody multibody(model);
    MultibodyState start = multibody.initial_state(std::vector<BodyWrench>(2));
    multibody.predict(start, 0, 0.1);
    const ContactWrenches none{std::vector<BodyWrench>(2), {}};
    for (int i = 0; i < 10; ++i) multibody.correct(none);
    const std::string trouble = multibody.trouble();
    CAPTURE(trouble);
    CHECK(contains(trouble, "; the largest gaps are those of joint "));
    CHECK(contains(trouble, " m: redundant constraints must not contradict each other"));
  }
  SECTION("a joint from ground to ground") {
    model.drivers.pop_back();
    model.joints.push_back(ground_pin("nowhere", kGround, {1, 2, 0}, {1, 2, 0}));
    CHECK(contains(refusal(model), "joint 'nowhere' has a condition that no motion of its bodies changes"));
  }
}

TEST_CASE("a matrix that is singular due to constraints alone is reported as a singular position") {
  Model model = closed_chain();
  model.joints.push_back(model.joints[1]);
  model.joints[3].name = "again";
  RigidBodySystem system(model);
  MultibodyState state;
  state.position.resize(6), state.velocity.resize(6);
  for (const auto& kind : system.kinds()) kind->start(state.position, state.velocity);
  HhtMethod method(system, -0.1, state.position, state.velocity);
  std::vector<Real> values(method.pattern().column.size()), rhs(14);
  method.acceleration_system(state, 0, values, rhs);
  CHECK(
      contains(matrix_failure(system, method.pattern(), values),
               "is singular: joint 'middle', joint 'again' are redundant in this position, or nearly so: it "
               "is singular; integrator.redundant = \"minimum-norm\" passes it"));
}

TEST_CASE("minimum-norm reactions of a rod of 0.1 um are those of a rod of 0.1 m, scaled") {
  petsc();
  // Lengths, masses and times by these powers of two: the numbers have the same digits.
  const auto start_of = [](int length, int mass, int time) {
    const auto metres = [&](Real x, Real y) { return Vec3{std::ldexp(x, length), std::ldexp(y, length), 0}; };
    Model model = empty_model();
    model.gravity = {}, model.consistent_velocities = true;
    model.integrator.redundant = RedundantRows::share;
    model.bodies = {paper_disc("rod", 0, 0)};
    Body& rod = model.bodies[0];
    rod.shapes.clear();
    rod.position = metres(0.3, 0.05), rod.velocity = (1 / std::ldexp(1.0, time)) * metres(-0.47, -0.017);
    rod.angular_velocity = std::ldexp(0.43, -time);
    rod.mass = std::ldexp(0.3, mass), rod.inertia = std::ldexp(3.4e-4, mass + 2 * length);
    model.joints = {ground_pin("pin", 0, metres(0.32, 0.07), metres(0.02, 0.02))};
    TimeFunction turn;
    turn.kind = TimeFunction::Kind::sine;
    turn.amplitude = 0.2, turn.frequency = std::ldexp(5, -time);
    model.drivers = {{"drive", 0, turn}};
    Multibody multibody(model);
    return multibody.initial_state(std::vector<BodyWrench>(1)).velocity;
  };
  const std::vector<Real> large = start_of(0, 0, 0), small = start_of(-20, -60, -10);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(near(std::ldexp(small[i], i < 2 ? 10 : -10), large[i], {.relative = 1e-12}));
}
