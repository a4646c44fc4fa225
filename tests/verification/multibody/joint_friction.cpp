// Dry friction of joints against closed forms.
#include <cmath>
#include <string>

#include "support/catch.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"

using namespace scree;

namespace {

constexpr Real kInertia = 0.005, kMu = 0.3;  // inertia of paper_disc; friction coefficient

Model slider_along(Vec3 axis) {
  Model model = empty_model();
  model.integrator.hht_alpha = -0.05;
  model.bodies = {paper_disc("block", 0, 0)};
  Joint joint;
  joint.name = "slide", joint.kind = JointKind::translational;
  joint.body[1] = 0, joint.axis = axis;
  model.joints = {joint};
  return model;
}

Model flywheel() {
  Model model = empty_model();
  model.gravity = {};
  model.integrator.hht_alpha = -0.02;
  model.bodies = {paper_disc("wheel", 0, 0)};
  model.joints = {ground_pin("pin", 0, {}, {})};
  return model;
}

JointFriction friction_of(Real effort, Real lever, Real stiffness, Real damping = 0) {
  JointFriction friction;
  friction.name = "friction";
  friction.effort = effort, friction.lever = lever, friction.stiffness = stiffness,
  friction.damping = damping;
  return friction;
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

Real effort_of(const MultibodyRun& run) {
  return run.multibody.joint_efforts(run.state, run.time).back().effort;
}

}  // namespace

TEST_CASE("a block on an incline below the limit does not creep in 1e5 steps") {
  Model model = slider_along({0.8, -0.6, 0});
  const Real pull = 0.6 * kGravity, k = 1e4;
  // Released on an empty spring it overshoots: at the first two limits it slides a little.
  for (const JointFriction& friction :
       {friction_of(1.02 * pull, 0, k, 50), friction_of(0, 0.8, k, 50), friction_of(2.1 * pull, 0, k, 50)}) {
    model.joint_frictions = {friction};
    MultibodyRun run(model, 1e-9);
    run.steps(5000, 1e-3);
    const Real hold = run.multibody.joint_efforts(run.state, run.time)[0].coordinate;
    run.steps(95000, 1e-3);
    if (friction.effort > 2 * pull) CHECK(near(hold, pull / k, {.relative = 1e-6}));
    CHECK(near(run.multibody.joint_efforts(run.state, run.time)[0].coordinate, hold, {.relative = 1e-9}));
    CHECK(near(effort_of(run), -pull, {.relative = 1e-9}));
    CHECK(std::abs(run.state.velocity[0]) < 1e-12);
  }
}

TEST_CASE("above the limit it slides with what is left, load-dependent or not") {
  Model model = slider_along({0.8, -0.6, 0});
  const Real pull = 0.6 * kGravity, across = 0.8 * kGravity, k = 1e5;
  // Braked by T after T / k; until then the spring's work is stored.
  const auto speed_after = [&](const JointFriction& friction, Real limit) {
    model.joint_frictions = {friction};
    MultibodyRun run(model, 1e-11);
    const Real start = energy(run);
    run.steps(1000, 1e-3);
    const Real way = run.multibody.joint_efforts(run.state, run.time)[0].coordinate;
    const Real lost = limit * (way - limit / k);
    CHECK(near(run.state.dissipated, lost, {.relative = 1e-5}));
    CHECK(near(effort_of(run), -limit, {.relative = 1e-7}));
    CHECK(near(energy(run), start, {.absolute = 1e-9}));
    const Real v = std::hypot(run.state.velocity[0], run.state.velocity[1]);
    CHECK(near(v * v / 2, pull * way - limit * (way - limit / (2 * k)), {.relative = 1e-3}));
    return v;
  };
  CHECK(near(speed_after(friction_of(0.7 * pull, 0, k), 0.7 * pull), 0.3 * pull, {.relative = 1e-2}));
  CHECK(near(speed_after(friction_of(0, kMu, k), kMu * across), pull - kMu * across, {.relative = 1e-2}));
  CHECK(near(speed_after(friction_of(1, kMu, k), 1 + kMu * across), pull - 1 - kMu * across,
             {.relative = 1e-2}));
}

TEST_CASE("a slider pressed by its weight stops from mu g and stays, to second order") {
  Model model = slider_along({1, 0, 0});
  model.bodies[0].velocity = {1, 0, 0};
  const Real limit = kMu * kGravity, k = 400, w = std::sqrt(k);
  model.joint_frictions = {friction_of(0, kMu, k)};
  // On the spring v = cos(w t) until the limit is reached, then v falls by mu g t.
  const Real slip = std::asin(limit / w) / w, speed = std::cos(w * slip);
  const auto exact = [&](Real t) { return t < slip ? std::cos(w * t) : speed - limit * (t - slip); };
  const auto error = [&](Real h) {
    MultibodyRun run(model, 1e-12);
    Real worst = 0;
    for (int i = 0; i < static_cast<int>(std::lround(0.3 / h)); ++i) {
      run.step(h);
      worst = std::max(worst, std::abs(run.state.velocity[0] - exact(run.time)));
    }
    return worst;
  };
  const Real coarse = error(2e-3), fine = error(5e-4);
  CHECK(fine < 1e-4);
  CHECK(coarse / fine > 10);
  model.joint_frictions[0].damping = 20;
  MultibodyRun run(model);
  run.steps(3000, 1e-3);
  CHECK(std::abs(run.state.velocity[0]) < 1e-6);
  CHECK(std::abs(effort_of(run)) < 1e-3);
}

TEST_CASE("a torsional oscillator loses 2 T/k in each half swing, and stays in the dead band") {
  Model model = flywheel();
  const Real k = 0.5, t = 0.03, stick = 50, start = 0.5;
  model.bodies[0].angle = start;
  model.joint_springs = {{"coil", 0, k, 0, 0, {}, {}}};
  model.joint_frictions = {friction_of(t, 0, stick, 0.05)};
  MultibodyRun run(model, 1e-11);
  const Real first = energy(run);
  std::vector<Real> turns;
  Real before = start;
  for (int i = 0; i < 10000; ++i) {
    const Real rate = run.state.velocity[2];
    run.step(2e-4);
    if (rate * run.state.velocity[2] < 0 && std::abs(run.angle(0)) > 1.2 * t / k)
      turns.push_back(std::abs(before));
    before = run.angle(0);
  }
  // With the energy returned by the friction's spring: k/2 (A^2 - B^2) = T (A + B - 2 T/stick), after the
  // first half oscillation, at whose start the spring is empty: T (A + B - T/stick) and T^2/(2 stick)
  // stored.
  REQUIRE(turns.size() >= 3);
  for (std::size_t i = 1; i < turns.size(); ++i) {
    const Real drop = 2 * t / k * (1 - 2 * t / stick / (turns[i] + turns[i - 1]));
    CHECK(near(turns[i - 1] - turns[i], drop, {.relative = 5e-3}));
  }
  CHECK(std::abs(run.angle(0)) < 1.01 * t / k);
  CHECK(std::abs(run.state.velocity[2]) < 1e-3);
  CHECK(near(energy(run), first, {.absolute = 1e-10}));
}

TEST_CASE("a pin with a radius brakes its wheel by mu R times the load") {
  Model model = flywheel();
  model.gravity = {0, -kGravity, 0};
  model.bodies[0].angular_velocity = 20;
  const Real torque = kMu * 0.02 * kGravity;
  model.joint_frictions = {friction_of(0, kMu * 0.02, 1e3)};
  MultibodyRun run(model, 1e-11);
  run.steps(500, 1e-3);
  CHECK(near(effort_of(run), -torque, {.relative = 1e-9}));
  const Real angle = run.angle(0), w = run.state.velocity[2];
  CHECK(near(w, 20 - torque / kInertia * 0.5, {.absolute = 0.02}));
  CHECK(near(kInertia / 2 * (400 - w * w), torque * (angle - torque / 2e3), {.relative = 1e-4}));
}

TEST_CASE("above the Stribeck rate friction falls from its static value") {
  Model model = flywheel();
  JointFriction friction = friction_of(0.02, 0, 1e3, 0.1);
  friction.static_ratio = 1.5, friction.stribeck_rate = 0.5;
  model.joint_frictions = {friction};
  AppliedForce push;
  push.torque.value = 0.029;
  model.applied_forces = {push};
  MultibodyRun held(model);
  held.steps(1000, 1e-3);
  CHECK(near(effort_of(held), -0.029, {.relative = 1e-5}));
  CHECK(std::abs(held.state.velocity[2]) < 1e-6);
  model.applied_forces[0].torque.value = 0.031;
  MultibodyRun torn(model);
  torn.steps(2000, 1e-3);
  CHECK(torn.state.velocity[2] > 2.5);
  CHECK(near(effort_of(torn), -0.02, {.relative = 1e-9}));
}

namespace {

// On a pin at one end, released from horizontal; the load of the pin changes continuously.
Model frictional_pendulum(Real alpha) {
  Model model = empty_model();
  model.integrator.hht_alpha = alpha;
  model.bodies = {paper_disc("bob", 0.5, 0)};
  model.joints = {ground_pin("pin", 0, {}, {-0.5, 0, 0})};
  model.joint_frictions = {friction_of(0.2, kMu * 0.05, 40)};
  return model;
}

// Crank and slider with friction in both pins, the wrist and the guide.
Model frictional_crank() {
  Model model = empty_model();
  model.integrator.hht_alpha = -0.1;
  const Real crank = 0.2, rod = 0.5, angle = 0.7;
  const Real knee_x = crank * std::cos(angle), knee_y = crank * std::sin(angle);
  const Real slider = knee_x + std::sqrt(rod * rod - knee_y * knee_y);
  model.bodies = {paper_disc("crank", knee_x / 2, knee_y / 2),
                  paper_disc("rod", (knee_x + slider) / 2, knee_y / 2), paper_disc("slider", slider, 0)};
  model.bodies[0].angle = angle, model.bodies[1].angle = -std::asin(knee_y / rod);
  model.bodies[0].angular_velocity = 12;
  model.consistent_velocities = true;
  model.joints = {ground_pin("shaft", 0, {}, {-crank / 2, 0, 0})};
  const auto add = [&](const char* name, int first, int second, Vec3 on_first, Vec3 on_second) {
    Joint joint = ground_pin(name, second, on_first, on_second);
    joint.body[0] = first;
    model.joints.push_back(joint);
  };
  add("knee", 0, 1, {crank / 2, 0, 0}, {-rod / 2, 0, 0});
  add("wrist", 1, 2, {rod / 2, 0, 0}, {});
  add("guide", kGround, 2, {}, {});
  model.joints.back().kind = JointKind::translational;
  for (int j = 0; j < 4; ++j) {
    model.joint_frictions.push_back(friction_of(0.02, j < 3 ? 0.1 * 0.02 : 0.1, j < 3 ? 5 : 2000, 0));
    model.joint_frictions.back().name = "friction." + std::to_string(j);
    model.joint_frictions.back().joint = j;
  }
  return model;
}

struct Outcome {
  std::vector<Real> position, velocity;
  Real gap = 0, dissipated = 0;
  int iterations = 0;
};

Outcome outcome_of(const Model& model, Real h, Real end) {
  MultibodyRun run(model, 1e-11);
  Outcome out;
  const Real start = energy(run);
  Real before = 0;
  for (int i = 0; i < static_cast<int>(std::lround(end / h)); ++i) {
    run.step(h);
    out.gap = std::max(out.gap, std::abs(energy(run) - start));
    REQUIRE(run.state.dissipated >= before - 1e-12);
    before = run.state.dissipated;
  }
  out.position = run.state.position, out.velocity = run.state.velocity;
  out.dissipated = run.state.dissipated, out.iterations = run.iterations;
  return out;
}

Real apart(const std::vector<Real>& a, const std::vector<Real>& b) {
  Real largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

TEST_CASE("friction under a changing load is of second order, in sliding and at reversal") {
  for (const Real end : {0.3, 1.2}) {  // in the first oscillation; after two revolutions
    INFO("until " << end);
    const Outcome exact = outcome_of(frictional_pendulum(-0.1), 5e-5, end),
                  coarse = outcome_of(frictional_pendulum(-0.1), 4e-3, end),
                  fine = outcome_of(frictional_pendulum(-0.1), 5e-4, end);
    CHECK(apart(coarse.position, exact.position) < 1e-3);
    CHECK(apart(coarse.position, exact.position) / apart(fine.position, exact.position) > 50);
    CHECK(apart(coarse.velocity, exact.velocity) / apart(fine.velocity, exact.velocity) > 50);
    CHECK((coarse.dissipated - exact.dissipated) / (fine.dissipated - exact.dissipated) > 50);
    CHECK(coarse.gap < 1e-13);
    CHECK(fine.gap < 1e-13);
    CHECK(fine.iterations < 4 * static_cast<int>(end / 5e-4));
  }
}

TEST_CASE("a crank with friction in all joints is of second order and balances its energy to round-off") {
  const Outcome exact = outcome_of(frictional_crank(), 1e-4, 1),
                coarse = outcome_of(frictional_crank(), 4e-3, 1),
                fine = outcome_of(frictional_crank(), 1e-3, 1);
  CHECK(apart(coarse.position, exact.position) < 2e-3);
  CHECK(apart(coarse.position, exact.position) / apart(fine.position, exact.position) > 12);
  CHECK(fine.dissipated > 1.5);
  // The joints' coordinates are linear in the bodies', so that the energy balance closes exactly.
  CHECK(coarse.gap < 1e-13);
  CHECK(fine.gap < 1e-13);
}

TEST_CASE("a rejected step leaves no trace in friction") {
  const Model model = frictional_pendulum(-0.1);
  MultibodyRun straight(model), tried(model);
  const ContactWrenches none{std::vector<BodyWrench>(1), {}};
  for (int i = 0; i < 200; ++i) {
    tried.multibody.predict(tried.state, tried.time, 0.03);
    for (int k = 0; k < 3; ++k) tried.multibody.correct(none);
    straight.step(2e-3), tried.step(2e-3);
  }
  CHECK(straight.state.position == tried.state.position);
  CHECK(straight.state.velocity == tried.state.velocity);
  CHECK(straight.state.memory == tried.state.memory);
  CHECK(straight.state.dissipated == tried.state.dissipated);
}
