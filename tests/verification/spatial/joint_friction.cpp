// Dry friction on the angle of a spatial revolute joint: wheels that rotate many times and stop.
#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

constexpr Real kInertia = 0.05, kMass = 3, kRate = 6 * M_PI, kStiffness = 0.2;

Joint axle_along(Vec3 axis) {
  const Vec3 turn = cross(Vec3{0, 0, 1}, axis);
  Joint axle = joint_at(JointKind::revolute, "axle", kGround, 0, {}, {});
  axle.marker[0] = exponential((std::atan2(norm(turn), axis.z) / norm(turn)) * turn);
  return axle;
}

// Rotates at kRate about its z axis, which is that of the revolute joint through its centre.
Model wheel_on(Vec3 axis) {
  Model model = spatial_model(-0.05);
  model.gravity = {};
  model.joints = {axle_along(axis)};
  model.bodies = {spatial_body("wheel", kMass, {0.03, 0.04, kInertia}, {}, model.joints[0].marker[0])};
  model.bodies[0].spin = {0, 0, kRate};
  model.joint_frictions.resize(1);
  model.joint_frictions[0].name = "friction", model.joint_frictions[0].stiffness = kStiffness;
  return model;
}
Model dry_wheel(Real torque) {
  Model model = wheel_on({0.48, -0.6, 0.64});
  model.joint_frictions[0].effort = torque;
  return model;
}
// Its weight is normal to the axle, which has friction.
Model heavy_wheel(Real torque) {
  Model model = wheel_on({0.6, 0.8, 0});
  model.gravity = {0, 0, -9.81};
  model.joint_frictions[0].lever = torque / (kMass * 9.81);
  return model;
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

JointEffortSample sample_of(const MultibodyRun& run) {
  return run.multibody.joint_efforts(run.state, run.time).at(0);
}

// Loads friction's spring up to this torque.
void wind(MultibodyRun& run, Real torque) {
  run.state.memory = {torque};
  run.multibody.solve_acceleration(run.state, 0, {BodyWrench{}});
}

// J c'' = -k c until the spring holds the torque T, then -T until the wheel stops.
struct Braking {
  explicit Braking(Real torque) {
    const Real frequency = std::sqrt(kStiffness / kInertia);
    const Real slip = std::asin(torque / (kInertia * frequency * kRate)) / frequency;
    const Real rate = kRate * std::cos(frequency * slip);
    time = slip + kInertia * rate / torque;
    angle = torque / kStiffness + kInertia * rate * rate / (2 * torque);
  }
  Real time, angle;  // when the wheel stops
};

// Between the two steps around it, by the parabolas of rate and angle.
Braking found_stop(const Model& model, Real h) {
  MultibodyRun run(model);
  JointEffortSample before, now = sample_of(run);
  do {
    before = now;
    run.step(h);
    now = sample_of(run);
  } while (now.rate > 0);
  Braking stop(1);
  const Real since = h * now.rate / (now.rate - before.rate);
  stop.time = run.time - since, stop.angle = now.coordinate - since * now.rate / 2;
  return stop;
}

}  // namespace

TEST_CASE(
    "a revolute joint with friction brakes its wheel uniformly over fourteen revolutions, at any step") {
  constexpr Real kTorque = 0.1, kStop = kInertia * kRate / kTorque, kAngle = kRate * kStop / 2;
  REQUIRE(kAngle > 14 * 2 * M_PI);
  for (Model model : {dry_wheel(kTorque), heavy_wheel(kTorque)}) {
    model.joint_frictions[0].damping = 2 * std::sqrt(kStiffness * kInertia);
    const Real h = GENERATE(4e-2, 7e-3);
    MultibodyRun run(model, 1e-9);
    wind(run, kTorque);
    const Real start = energy(run);
    CHECK(near(start, kTorque * kAngle + kTorque * kTorque / (2 * kStiffness), {.relative = 1e-12}));
    JointEffortSample before, now = sample_of(run);
    Real angle = 0, rate = 0, effort = 0, loss = 0;
    for (;; before = now) {
      run.step(h);
      now = sample_of(run);
      if (run.time >= kStop) break;
      angle = std::max(
          angle, std::abs(now.coordinate -
                          (kAngle - (kTorque / kInertia / 2) * (kStop - run.time) * (kStop - run.time))));
      rate = std::max(rate, std::abs(now.rate - kTorque / kInertia * (kStop - run.time)));
      effort = std::max(effort, std::abs(now.effort + kTorque));
      loss = std::max(loss, std::abs(run.state.dissipated - kTorque * now.coordinate));
    }
    for (const Real error : {angle, rate, effort, loss})
      CHECK(measured("revolute_friction/braked", "", at_most(error, 1e-9)));
    // The last rate before the stop and the first one after it, when the spring releases.
    CHECK(near(run.time - h * now.rate / (now.rate - before.rate), kStop, {.absolute = 1e-2 * h}));
    // It comes to rest where the spring is empty.
    run.steps(static_cast<int>(15 / h), h);
    CHECK(std::abs(sample_of(run).rate) < 1e-9);
    CHECK(near(sample_of(run).coordinate, kAngle - kTorque / kStiffness, {.absolute = h * h}));
    CHECK(near(run.state.dissipated, start, {.relative = 1e-6}));
    CHECK(near(energy(run), start, {.relative = 1e-12}));
  }
}

TEST_CASE("from an empty spring on a wheel stops when and where it must, to second order") {
  // The phase of the step at which sliding begins determines the error: the worst of ten such phases.
  struct Errors {
    Real time = 0, angle = 0;
  };
  for (const auto& wheel : {dry_wheel, heavy_wheel}) {
    const auto worst = [&](Real h) {
      Errors errors;
      for (int i = 0; i < 10; ++i) {
        const Real torque = 0.1 + 7e-4 * i;
        const Braking exact(torque), found = found_stop(wheel(torque), h);
        errors.time = std::max(errors.time, std::abs(found.time - exact.time));
        errors.angle = std::max(errors.angle, std::abs(found.angle - exact.angle));
      }
      return errors;
    };
    const Errors coarse = worst(1e-2), fine = worst(1e-2 / 16);
    CHECK(fine.time < 3e-6);
    CHECK(fine.angle < 6e-5);
    for (const Real ratio : {coarse.time / fine.time, coarse.angle / fine.angle})
      CHECK(measured("revolute_friction/stop order", "", at_least(std::log2(ratio) / 4, 1.7)));
  }
}

// The centre is e off the axle, whose load is m e sqrt(w^4 + w'^2): then w' = -k w^2, with the solution w =
// w_0 / (1 + k w_0 t).
TEST_CASE("an unbalanced wheel is braked by the force that it needs to go round, to second order") {
  constexpr Real kOffset = 0.02, kLever = 0.25 * 0.02, kEnd = 10;
  const Real share = kLever * kMass * kOffset / (kInertia + kMass * kOffset * kOffset);
  const Real root = std::sqrt(1 - share * share), k = share / root;
  Model model = wheel_on({0.48, -0.6, 0.64});
  Body& wheel = model.bodies[0];
  const Mat3 rotation = rotation_matrix(wheel.orientation);
  model.joints[0].point[1] = {kOffset, 0, 0};
  wheel.position = rotation * Vec3{-kOffset, 0, 0};
  wheel.velocity = rotation * Vec3{0, -kRate * kOffset, 0};
  model.joint_frictions[0].lever = kLever, model.joint_frictions[0].stiffness = 2;
  const auto effort = [&](Real rate) { return kLever * kMass * kOffset * rate * rate / root; };
  struct Errors {
    Real rate = 0, angle = 0, effort = 0;
  };
  const auto errors_at = [&](Real h) {
    MultibodyRun run(model);
    wind(run, effort(kRate));
    const Real start = energy(run);
    Errors errors;
    while (run.time < kEnd) {
      run.step(h);
      const JointEffortSample now = sample_of(run);
      const Real growth = 1 + k * kRate * run.time, rate = kRate / growth;
      errors.rate = std::max(errors.rate, std::abs(now.rate - rate));
      errors.angle = std::max(errors.angle, std::abs(now.coordinate - std::log(growth) / k));
      errors.effort = std::max(errors.effort, std::abs(now.effort + effort(rate)));
      REQUIRE(near(energy(run), start, {.relative = 1e-9}));
    }
    CHECK(sample_of(run).coordinate > 20 * 2 * M_PI);
    CHECK(run.state.dissipated > 0.6 * start);
    return errors;
  };
  const Errors coarse = errors_at(1e-2), fine = errors_at(5e-3);
  CHECK(fine.rate < 5e-3);
  CHECK(fine.angle < 4e-2);
  for (const Real ratio : {coarse.rate / fine.rate, coarse.angle / fine.angle, coarse.effort / fine.effort})
    CHECK(measured("revolute_friction/halved", "", in_range(ratio, 3.8, 4.2)));
}

// J c'' = T - (lever + p) F with p the lead per radian and F = m (g + p c'') on the thread: the effect of
// friction on the motion changes the load on which it depends by more than itself, as the assertion shows.
TEST_CASE("a heavy jack on a self-locking thread rises uniformly and balances its energy") {
  constexpr Real kLoad = 1e5, kSpindle = 0.1, kPitch = 1.6e-3, kLever = 3e-3;
  constexpr Real kTorque = 6000, kFade = 2000;  // [N m], [N m/s]
  static_assert(kLever * kLoad * kPitch > kSpindle + kLoad * kPitch * kPitch);
  Model model = spatial_model(-0.05);
  model.bodies = {spatial_body("nut", kLoad, {1, 1, kSpindle}, {})};
  model.joints = {joint_at(JointKind::screw, "thread", kGround, 0, {}, {})};
  model.joints[0].lead = 2 * M_PI * kPitch;
  model.joint_frictions.resize(1);
  JointFriction& friction = model.joint_frictions[0];
  friction.name = "friction", friction.coordinate = JointCoordinate::angle;
  friction.lever = kLever, friction.stiffness = 1e7;
  Motor motor;
  motor.name = "motor", motor.coordinate = JointCoordinate::angle;
  motor.effort.kind = TimeFunctionKind::ramp, motor.effort.value = kTorque, motor.effort.rate = -kFade;
  model.motors = {motor};
  const Real divisor = kSpindle + (kLever + kPitch) * kLoad * kPitch;
  const auto rise = [&](Real t, Real push = 0) {
    return (kTorque - kFade * t - (kLever + kPitch) * (kLoad * 9.81 + push)) / divisor;
  };
  const auto friction_effort = [&](Real t, Real push = 0) {
    return kLever * (kLoad * (9.81 + kPitch * rise(t, push)) + push);
  };
  MultibodyRun run(model);
  wind(run, friction_effort(0));
  const Real start = energy(run);
  Real first = 0;  // the error of the start, which is constant
  for (int i = 0; i < 200; ++i) {
    run.step(2e-3);
    const Real t = run.time;
    const auto samples = run.multibody.joint_efforts(run.state, t);
    const Real error = samples[1].rate - (rise(0) * t - kFade * t * t / 2 / divisor);
    if (i == 0) first = error;
    REQUIRE(std::abs(first) < 1e-3);
    REQUIRE(near(error, first, {.absolute = 1e-8}));
    REQUIRE(near(samples[1].effort, -friction_effort(t), {.relative = 1e-9}));
  }
  CHECK(run.state.dissipated > 4e5);
  CHECK(near(energy(run), start, {.absolute = 1e-12 * run.state.driver_work}));
  // A contact that pushes it down at the end of a step loads the thread at once.
  constexpr Real kPush = 2e5;
  std::vector<BodyWrench> push(1);
  push[0].force.z = -kPush;
  run.multibody.predict(run.state, run.time, 2e-3);
  for (int i = 0; i < 4; ++i) run.multibody.correct({std::vector<BodyWrench>(1), {}});
  run.multibody.accept(run.state, push);
  const Real t = run.time + 2e-3;
  CHECK(near(run.multibody.joint_efforts(run.state, t)[1].effort, -friction_effort(t, kPush),
             {.relative = 1e-9}));
  CHECK(friction_effort(t, kPush) > friction_effort(t) + 50);
}
