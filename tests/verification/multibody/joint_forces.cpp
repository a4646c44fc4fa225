// Motors, springs and limits on joints, and couplers, against closed forms.
#include <cmath>
#include <string>

#include "support/catch.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"

using namespace scree;

namespace {

constexpr Real kRoundOff = 1e-11;

// A disc on a pin at its centre: a flywheel. Inertia 0.005 kg m^2.
Model flywheel(int wheels = 1) {
  Model model = empty_model();
  model.gravity = {};
  model.integrator.hht_alpha = -0.02;
  model.time.end = 10;
  for (int i = 0; i < wheels; ++i) {
    model.bodies.push_back(paper_disc("wheel." + std::to_string(i), i, 0));
    model.joints.push_back(ground_pin("pin." + std::to_string(i), i, {Real(i), 0, 0}, {0, 0, 0}));
  }
  return model;
}
constexpr Real kInertia = 0.005;

// A disc of 1 kg that slides along x.
void add_slider(Model& model) {
  model.bodies.push_back(paper_disc("slider", 0, 0));
  Joint joint;
  joint.name = "slide";
  joint.kind = JointKind::translational;
  joint.body[1] = static_cast<int>(model.bodies.size()) - 1;
  model.joints.push_back(joint);
}
Model slider() {
  Model model = flywheel(0);
  add_slider(model);
  return model;
}

TimeFunction constant(Real value) {
  TimeFunction function;
  function.value = value;
  return function;
}

Motor motor_of(MotorKind kind) {
  Motor motor;
  motor.name = "motor";
  motor.kind = kind;
  return motor;
}

Motor torque_motor(Real torque) {
  Motor motor = motor_of(MotorKind::effort);
  motor.effort = constant(torque);
  return motor;
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

// Largest error of the rate of the first wheel over half a second.
template <class Exact>
Real rate_error(const Model& model, Real h, const Exact& exact) {
  MultibodyRun run(model, 1e-12);
  Real worst = 0;
  const int steps = static_cast<int>(std::lround(0.5 / h));
  for (int i = 0; i < steps; ++i) {
    run.step(h);
    worst = std::max(worst, std::abs(run.state.velocity[2] - exact(run.time)));
  }
  return worst;
}

}  // namespace

TEST_CASE("a constant torque rotates a flywheel by T t^2 / 2 J, and its work is the kinetic energy") {
  Model model = flywheel();
  model.motors = {torque_motor(0.02)};
  MultibodyRun run(model);
  run.steps(100, 1e-2);
  CHECK(near(run.angle(0), 0.02 / (2 * kInertia), {.relative = kRoundOff}));
  CHECK(near(run.state.driver_work, 0.02 * run.angle(0), {.relative = kRoundOff}));
  CHECK(near(energy(run), 0, {.absolute = kRoundOff}));
  const JointEffortSample sample = run.multibody.joint_efforts(run.state, run.time).at(0);
  CHECK(sample.name == "motor");
  CHECK(sample.is_angle);
  CHECK(near(sample.effort, 0.02, {.relative = kRoundOff}));
  CHECK(near(sample.coordinate, run.angle(0), {.relative = kRoundOff}));
  CHECK(near(sample.power, 0.02 * 0.02 / kInertia, {.relative = 1e-9}));
}

TEST_CASE("a motor on its torque-speed line comes up to speed exponentially, to second order") {
  Model model = flywheel();
  Motor motor = motor_of(MotorKind::line);
  motor.stall_effort = 0.1, motor.free_rate = 5, motor.command = constant(0.8);
  model.motors = {motor};
  const Real rate = motor.stall_effort / (kInertia * motor.free_rate);
  const auto exact = [&](Real t) { return 0.8 * 5 * (1 - std::exp(-rate * t)); };
  const Real coarse = rate_error(model, 5e-3, exact), fine = rate_error(model, 2.5e-3, exact);
  CHECK(fine < 1e-3);
  CHECK(coarse / fine > 3.7);
  CHECK(coarse / fine < 4.3);
}

TEST_CASE("a limit holds a motor back until its line falls below it") {
  Model model = flywheel();
  Motor motor = motor_of(MotorKind::line);
  motor.stall_effort = 0.1, motor.free_rate = 5, motor.command = constant(1), motor.limit = 0.04;
  model.motors = {motor};
  MultibodyRun run(model);
  // The line falls to the limit at 3 rad/s: until then the torque is constant.
  run.steps(36, 1e-2);
  CHECK(near(run.state.velocity[2], 0.04 / kInertia * 0.36, {.relative = 1e-9}));
  CHECK(near(run.multibody.joint_efforts(run.state, run.time).at(0).effort, 0.04, {.relative = kRoundOff}));
  run.steps(200, 1e-2);
  CHECK(near(run.state.velocity[2], 5, {.absolute = 1e-3}));
}

TEST_CASE("a speed controller takes a load without a rest of error, to second order") {
  Model model = flywheel();
  Motor motor = motor_of(MotorKind::speed);
  motor.rate = constant(2), motor.gain = 0.1, motor.integral_gain = 0.3;
  model.motors = {motor};
  AppliedForce load;
  load.torque = constant(-0.03);
  model.applied_forces = {load};
  // J e'' + P e' + I e = 0, e = 2 - w, e(0) = 2, J e'(0) = -(P e(0) + load): two real roots.
  const Real p = motor.gain / kInertia, i = motor.integral_gain / kInertia, root = std::sqrt(p * p / 4 - i);
  const Real a = -p / 2 + root, b = -p / 2 - root, start = -p * 2 + 0.03 / kInertia;
  const Real second = (start - 2 * a) / (b - a), first = 2 - second;
  const auto exact = [&](Real t) { return 2 - (first * std::exp(a * t) + second * std::exp(b * t)); };
  const Real coarse = rate_error(model, 5e-3, exact), fine = rate_error(model, 2.5e-3, exact);
  CHECK(fine < 2e-3);
  CHECK(coarse / fine > 3.7);
  CHECK(coarse / fine < 4.3);
  MultibodyRun run(model);
  run.steps(400, 1e-2);
  CHECK(near(run.state.velocity[2], 2, {.absolute = 1e-7}));
  CHECK(near(motor.integral_gain * run.state.memory.at(0), 0.03, {.absolute = 1e-7}));
}

TEST_CASE("the integral of a speed controller is constant while the limit acts") {
  Model model = flywheel();
  Motor motor = motor_of(MotorKind::speed);
  motor.rate = constant(20), motor.gain = 0.1, motor.integral_gain = 0.5, motor.limit = 0.05;
  model.motors = {motor};
  MultibodyRun run(model);
  Real fastest = 0;
  for (int i = 0; i < 600; ++i) {
    run.step(1e-2);
    fastest = std::max(fastest, run.state.velocity[2]);
    if (run.state.velocity[2] < 19) REQUIRE(run.state.memory.at(0) == 0);
    REQUIRE(std::abs(run.multibody.joint_efforts(run.state, run.time).at(0).effort) <= 0.05);
  }
  CHECK(near(run.state.velocity[2], 20, {.absolute = 1e-6}));
  // From e = 0.5, where the motor leaves its limit, critically damped: e = (0.5 - 5 t) exp(-10 t). With an
  // integral over the time at the limit it would overshoot far.
  CHECK(near(fastest, 20 + 0.5 * std::exp(-2.0), {.absolute = 1e-3}));
}

TEST_CASE("springs on joints: a table of a straight line is a stiffness, a quintic's energy is exact") {
  Model model = flywheel();
  model.bodies[0].angular_velocity = 1;
  model.joint_springs = {{"spring", 0, 0.3, 0, 0.1, {}, {}}};
  MultibodyRun one(model);
  model.joint_springs = {{"spring", 0, 0, 0, 0, {{-1.0, 2.0}, {-0.33, 0.57}}, {}}};
  MultibodyRun other(model);
  one.steps(100, 5e-3), other.steps(100, 5e-3);
  CHECK(near(one.angle(0), other.angle(0), {.absolute = 1e-10}));
  // Undamped: w^2 + (k/J)(angle - 0.1)^2 is constant.
  const Real k = 0.3 / kInertia, stretch = one.angle(0) - 0.1;
  CHECK(near(one.state.velocity[2] * one.state.velocity[2] + k * stretch * stretch, 1 + k * 0.01,
             {.relative = 1e-2}));

  // Damping from a table of c', d = 0.01: e^-2t in the rate.
  model.joint_springs = {{"damper", 0, 0, 0, 0, {}, {{-5, 5}, {-0.05, 0.05}}}};
  MultibodyRun damped(model);
  damped.steps(500, 1e-3);
  CHECK(near(damped.state.velocity[2], std::exp(-1.0), {.absolute = 1e-6}));
  CHECK(near(damped.state.dissipated, kInertia / 2 * (1 - std::exp(-2.0)), {.absolute = 1e-8}));
  CHECK(near(energy(damped), kInertia / 2, {.relative = 1e-8}));
}

TEST_CASE("a spring without a free coordinate has no effort at the start") {
  Model model = flywheel();
  model.bodies[0].angle = 0.4;
  add_slider(model);
  model.bodies[1].position = {0.3, 0, 0};
  model.joint_springs = {{"coil", 0, 2, 0, {}, {}, {}}, {"spring", 1, 50, 0, {}, {}, {}}};
  MultibodyRun run(model);
  for (const JointEffortSample& sample : run.multibody.joint_efforts(run.state, 0)) CHECK(sample.effort == 0);
  CHECK(run.multibody.joint_efforts(run.state, 0).at(1).coordinate == 0.3);
  CHECK(run.state.acceleration == std::vector<Real>(6, 0));
}

TEST_CASE("a limit rebounds a slider as its contact law; undamped and linear at any step") {
  struct Case {
    Real damping, exponent, steps, rebound, allowed;  // steps: per contact
  };
  const Real k = 1e4, speed = 1;
  const Real zeta = 0.1, damping = 2 * zeta * std::sqrt(k);
  // Clipped at zero (see METHOD's closed forms): the contact ends when the force does.
  const Real root = std::sqrt(1 - zeta * zeta), wd = std::sqrt(k) * root;
  const Real time = (M_PI - std::atan(2 * zeta * root / (1 - 2 * zeta * zeta))) / wd;
  const Real restitution = std::exp(-zeta * std::sqrt(k) * time);
  for (const Case& c : {Case{0, 1, 20, 1, 1e-9}, Case{0, 1, 1, 1, 1e-9}, Case{0, 1, 0.4, 1, 1e-9},
                        Case{0, 1.5, 20, 1, 5e-3}, Case{damping, 1, 20, restitution, 1e-2}}) {
    for (const Real side : {1.0, -1.0}) {
      Model model = slider();
      model.integrator.hht_alpha = 0;
      model.bodies[0].velocity = {side * speed, 0, 0};
      JointLimit limit;
      limit.name = "stop";
      (side > 0 ? limit.upper : limit.lower) = side * 0.1;
      limit.stiffness = k, limit.damping = c.damping, limit.exponent = c.exponent;
      model.joint_limits = {limit};
      MultibodyRun run(model, 1e-12);
      const Real h = M_PI / std::sqrt(k) / c.steps;
      run.steps(static_cast<int>(std::lround(0.3 / h)), h);
      INFO("C = " << c.damping << ", n = " << c.exponent << ", " << c.steps << " steps, side " << side);
      CHECK(near(-side * run.state.velocity[0], c.rebound * speed, {.absolute = c.allowed}));
      CHECK(near(energy(run), 0.5, {.absolute = 1e-10}));
      const Real lost = 0.5 * (1 - run.state.velocity[0] * run.state.velocity[0]);
      CHECK(near(run.state.dissipated + run.state.integrator_loss, lost, {.absolute = 1e-10}));
    }
  }
}

TEST_CASE("gears, belts, racks and differentials distribute torques by their ratios") {
  // Two wheels: torque T on the first; a_1 = T / (J + J r^2) with c_1 + r c_2 fixed at r = ratio... of c_2 =
  // -c_1 / r.
  for (const Real ratio : {2.0, -2.0}) {
    Model model = flywheel(2);
    model.motors = {torque_motor(0.02)};
    model.couplers = {{"gear", {0, 1}, {1, ratio}}};
    MultibodyRun run(model);
    run.steps(100, 1e-2);
    const Real angle = 0.02 / (kInertia * (1 + 1 / (ratio * ratio))) / 2;
    CHECK(near(run.angle(0), angle, {.relative = 1e-9}));
    CHECK(near(run.angle(1), -angle / ratio, {.relative = 1e-9}));
    // The reaction is the missing torque on the first wheel.
    const Reaction reaction = run.multibody.reactions(run.state, run.time).back();
    CHECK(reaction.joint == "gear");
    CHECK(near(reaction.torque.z, 2 * angle * kInertia - 0.02, {.relative = 1e-8}));
  }
  // Rack and pinion: x = r c.
  Model rack = flywheel(1);
  add_slider(rack);
  rack.motors = {torque_motor(0.02)};
  rack.couplers = {{"rack", {0, 1}, {-0.1, 1}}};
  MultibodyRun pinion(rack);
  pinion.steps(100, 1e-2);
  const Real angle = 0.02 / (kInertia + 1 * 0.1 * 0.1) / 2;
  CHECK(near(pinion.angle(0), angle, {.relative = 1e-9}));
  CHECK(near(pinion.x(1), 0.1 * angle, {.relative = 1e-9}));
  // Differential: the carrier's torque is divided equally; one side is ten times as heavy.
  Model differential = flywheel(3);
  differential.bodies[1].inertia = 10 * kInertia;
  Motor motor = torque_motor(0.02);
  motor.joint = 2;
  differential.motors = {motor};
  differential.couplers = {{"differential", {0, 1, 2}, {1, 1, -2}}};
  MultibodyRun axle(differential);
  axle.steps(100, 1e-2);
  CHECK(near(axle.angle(0), 10 * axle.angle(1), {.relative = 1e-8}));
  CHECK(near(axle.angle(2), (axle.angle(0) + axle.angle(1)) / 2, {.relative = 1e-9}));
  // J a_1 = 10 J a_2 = S, J (a_1 + a_2)/2 = T - 2 S.
  const Real side = 0.02 / (2 + 0.55);
  CHECK(near(axle.angle(0), side / kInertia / 2, {.relative = 1e-8}));
}

TEST_CASE(
    "the energy balance closes: to round-off on revolute joints, to second order on a rotating slider") {
  Model model = flywheel();
  model.gravity = {0, -kGravity, 0};
  model.joints[0].point[0] = model.joints[0].point[1] = {-0.3, 0, 0};
  Motor motor = motor_of(MotorKind::speed);
  motor.rate = constant(4), motor.gain = 1, motor.integral_gain = 3, motor.limit = 5;
  model.motors = {motor};
  model.joint_springs = {{"spring", 0, 2, 0.1, 0, {}, {}}};
  JointLimit limit;
  limit.name = "stop";
  limit.upper = 0.8, limit.stiffness = 3000, limit.damping = 3;
  model.joint_limits = {limit};
  const auto gap = [&](Real h) {
    MultibodyRun run(model, 1e-11);
    const Real start = energy(run);
    Real worst = 0;
    const int steps = static_cast<int>(std::lround(1 / h));
    for (int i = 0; i < steps; ++i) {
      run.step(h);
      worst = std::max(worst, std::abs(energy(run) - start));
    }
    return worst;
  };
  CHECK(gap(2e-3) < 1e-12);
  // A slider with all of these on the wheel, too: along a rotating axis, g.(q_1 - q_0) is not c_1 - c_0.
  model.bodies.push_back(paper_disc("slider", 0.1, 0.05));
  Joint slide;
  slide.name = "slide", slide.kind = JointKind::translational;
  slide.body[0] = 0, slide.body[1] = 1;
  slide.point[0] = {0.1, 0.05, 0}, slide.axis = {0.6, 0.8, 0};
  model.joints.push_back(slide);
  motor.joint = 1, motor.rate = constant(0.3), motor.gain = 20, motor.limit = 8;
  model.motors.push_back(motor);
  model.joint_springs.push_back({"slider's", 1, 30, 0.5, 0, {}, {}});
  limit.joint = 1, limit.upper = 0.05, limit.lower = -0.05;
  model.joint_limits.push_back(limit);
  const Real coarse = gap(1e-3), fine = gap(5e-4);
  CHECK(fine < 1e-3);
  CHECK(coarse / fine > 3.5);
}
