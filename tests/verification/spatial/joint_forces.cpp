// Motors, springs and limits on the joints of spatial bodies.
#include <cmath>

#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

// A frame whose z is the axis: the shortest rotation from z.
Quaternion towards(Vec3 axis) {
  const Vec3 turn = cross(Vec3{0, 0, 1}, axis);
  return exponential((std::atan2(norm(turn), axis.z) / norm(turn)) * turn);
}

Joint slide_along(int first, int second, Vec3 on_first, Vec3 on_second, Vec3 axis) {
  Joint joint = joint_at(JointKind::translational, "slide", first, second, on_first, on_second);
  joint.marker[0] = joint.marker[1] = towards(axis);
  return joint;
}

TimeFunction constant(Real value) {
  TimeFunction function;
  function.value = value;
  return function;
}

Motor pusher(Real wanted, Real gain, Real integral_gain) {
  Motor motor;
  motor.name = "motor", motor.kind = MotorKind::speed;
  motor.rate = constant(wanted), motor.gain = gain, motor.integral_gain = integral_gain;
  return motor;
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

}  // namespace

TEST_CASE("a spring lets a slider down an oblique axis and takes it back, to second order") {
  const Vec3 axis{1.0 / 3, -2.0 / 3, -2.0 / 3};
  Model model = spatial_model(-0.05);
  model.bodies = {spatial_body("slider", 2, {0.1, 0.2, 0.15}, {0, 0, 0})};
  model.joints = {slide_along(kGround, 0, {0, 0, 0}, {0, 0, 0}, axis)};
  model.joint_springs = {{"spring", 0, 50, 0, {}, {}, {}}};
  const Real pull = 2 * 9.81 * 2 / 3, w = 5;
  const auto error = [&](Real h) {
    MultibodyRun run(model, 1e-12);
    Real worst = 0;
    for (int i = 0; i < static_cast<int>(std::lround(1 / h)); ++i) {
      run.step(h);
      const Real c = run.multibody.joint_efforts(run.state, run.time).at(0).coordinate;
      worst = std::max(worst, std::abs(c - pull / 50 * (1 - std::cos(w * run.time))));
    }
    return worst;
  };
  const Real coarse = error(1e-2), fine = error(5e-3);
  CHECK(fine < 2e-3);
  CHECK(coarse / fine > 3.7);
  CHECK(coarse / fine < 4.3);
}

TEST_CASE(
    "friction of a slider on an oblique axis follows the force across it: it holds, or slides with the "
    "rest") {
  const Vec3 axis{1.0 / 3, -2.0 / 3, -2.0 / 3};
  Model model = spatial_model(-0.05);
  model.bodies = {spatial_body("slider", 2, {0.1, 0.2, 0.15}, {0, 0, 0})};
  model.joints = {slide_along(kGround, 0, {0.1, 0.2, 0}, {0.1, 0.2, 0}, axis)};
  const Real along = 9.81 * 2 / 3, across = 9.81 * std::sqrt(5.0) / 3;
  JointFriction friction;
  friction.name = "friction", friction.stiffness = 4e4, friction.damping = 60;
  const auto outcome = [&](Real mu) {
    friction.lever = mu;
    model.joint_frictions = {friction};
    MultibodyRun run(model, 1e-11);
    run.steps(1000, 1e-3);
    return run.multibody.joint_efforts(run.state, run.time).at(0);
  };
  const JointEffortSample held = outcome(1.2), slid = outcome(0.3);
  CHECK(near(held.effort, -2 * along, {.relative = 1e-6}));
  CHECK(std::abs(held.rate) < 1e-7);
  CHECK(near(slid.effort, -2 * 0.3 * across, {.relative = 1e-6}));
  CHECK(near(slid.rate, along - 0.3 * across, {.relative = 2e-3}));
}

namespace {

// Two free bodies in rigid rotation, on a joint between them.
Model free_pair(JointKind kind) {
  Model model = spatial_model(-0.05);
  model.gravity = {};
  model.bodies = {spatial_body("one", 2, {0.1, 0.2, 0.15}, {0, 0, 0}),
                  spatial_body("two", 1, {0.05, 0.08, 0.06}, {0.3, 0.1, 0.2})};
  for (Body& body : model.bodies) body.spin = {1, -2, 0.5};
  model.bodies[1].velocity = cross(Vec3{1, -2, 0.5}, Vec3{0.3, 0.1, 0.2});
  model.joints = {slide_along(0, 1, {0.3, 0.1, 0.2}, {0, 0, 0}, {0.6, 0, 0.8})};
  model.joints[0].kind = kind;
  return model;
}

// A motor, a spring and a limit on the displacement.
Model pushed_pair() {
  Model model = free_pair(JointKind::translational);
  model.motors = {pusher(0.5, 4, 10)};
  model.motors[0].limit = 3;
  model.joint_springs = {{"spring", 0, 20, 0.5, {}, {}, {}}};
  JointLimit limit;
  limit.name = "stop", limit.upper = 0.06, limit.stiffness = 2000, limit.damping = 2;
  model.joint_limits = {limit};
  return model;
}

// These elements on the displacement of a cylindrical joint, and others on its angle.
Model pushed_and_turned_pair() {
  Model model = free_pair(JointKind::cylindrical);
  const Model pushed = pushed_pair();
  for (const JointCoordinate coordinate : {JointCoordinate::displacement, JointCoordinate::angle}) {
    for (Motor e : pushed.motors) e.coordinate = coordinate, model.motors.push_back(e);
    for (JointSpring e : pushed.joint_springs) e.coordinate = coordinate, model.joint_springs.push_back(e);
    for (JointLimit e : pushed.joint_limits) e.coordinate = coordinate, model.joint_limits.push_back(e);
  }
  model.motors[1].rate.value = 4, model.joint_springs[1].stiffness = 0.5,
  model.joint_springs[1].damping = 0.02;
  model.joint_limits[1].upper = 1, model.joint_limits[1].stiffness = 30, model.joint_limits[1].damping = 0.05;
  return model;
}

void check_momentum_and_energy(const Model& model) {
  struct Gap {
    Real energy = 0, momentum = 0, spin = 0;
  };
  const auto momentum = [&](const MultibodyRun& run, Vec3& spin) {
    const std::vector<BodyMotion> motion = run.multibody.motion(run.state);
    Vec3 sum;
    spin = {};
    for (std::size_t b = 0; b < 2; ++b) {
      const Body& body = model.bodies[b];
      const Vec3 p = body.mass * motion[b].velocity;
      sum += p;
      spin += cross(motion[b].position, p) +
              rotation_matrix(motion[b].orientation) * (body.inertia_tensor * motion[b].spin);
    }
    return sum;
  };
  const auto gap = [&](Real h) {
    MultibodyRun run(model, 1e-11);
    Gap worst;
    Vec3 spin0, spin;
    const Vec3 p0 = momentum(run, spin0);
    const Real start = energy(run);
    for (int i = 0; i < static_cast<int>(std::lround(0.8 / h)); ++i) {
      run.step(h);
      worst.energy = std::max(worst.energy, std::abs(energy(run) - start));
      worst.momentum = std::max(worst.momentum, norm(momentum(run, spin) - p0));
      worst.spin = std::max(worst.spin, norm(spin - spin0));
    }
    return worst;
  };
  const Gap coarse = gap(2e-3), fine = gap(1e-3);
  CHECK(fine.momentum < 1e-10);
  CHECK(fine.spin < 1e-4);
  CHECK(coarse.spin / fine.spin > 3.5);
  CHECK(fine.energy < 1e-3);
  CHECK(coarse.energy / fine.energy > 3.5);
}

}  // namespace

TEST_CASE("efforts on a joint between two free rotating bodies keep momentum, and balance the energy") {
  check_momentum_and_energy(pushed_pair());
  check_momentum_and_energy(pushed_and_turned_pair());
}
