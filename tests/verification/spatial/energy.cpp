// The energy balance of a spatial mechanism with motors, springs, limits, friction and a bushing.
#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

// An arm on an oblique revolute joint, a slider on the arm, and a block on a bushing on the slider.
Model crane() {
  Model model = spatial_model(-0.05);
  model.consistent_velocities = true;
  model.bodies = {
      spatial_body("arm", 1.5, {0.05, 0.06, 0.04}, {0.3, 0.1, 0}, exponential({0.2, 0.1, -0.3})),
      spatial_body("slider", 0.6, {0.002, 0.003, 0.0025}, {0.5, 0.1, 0.05}, exponential({0.5, 0.1, 0.2})),
      spatial_body("block", 0.8, {0.003, 0.002, 0.004}, {0.6, 0.2, 0})};
  const auto joint = [&](JointKind kind, const char* name, int first, int second, Vec3 point, Vec3 axis) {
    Joint joint = joint_at(kind, name, first, second, {}, {});
    const Vec3 turn = cross(Vec3{0, 0, 1}, axis);
    const Quaternion frame = exponential((std::atan2(norm(turn), axis.z) / norm(turn)) * turn);
    for (int i = 0; i < 2; ++i) {
      joint.point[i] = point, joint.marker[i] = frame;
      if (joint.body[i] == kGround) continue;
      const Body& body = model.bodies[static_cast<std::size_t>(joint.body[i])];
      joint.point[i] = transposed(rotation_matrix(body.orientation)) * (point - body.position);
      joint.marker[i] = conjugate(body.orientation) * frame;
    }
    model.joints.push_back(joint);
  };
  joint(JointKind::revolute, "hinge", kGround, 0, {0, 0.1, 0}, {0.36, 0.48, 0.8});
  joint(JointKind::cylindrical, "slide", 0, 1, {0.5, 0.1, 0}, {0.8, 0, 0.6});
  return model;
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

void add_motors(Model& model) {
  Motor drive, pull;
  drive.name = "drive", drive.kind = MotorKind::speed, drive.rate.value = 5, drive.gain = 2,
  drive.integral_gain = 20, drive.limit = 8;
  pull.name = "pull", pull.kind = MotorKind::line, pull.joint = 1,
  pull.coordinate = JointCoordinate::displacement;
  pull.stall_effort = 12, pull.free_rate = 3, pull.command.value = 1;
  model.motors = {drive, pull};
}
void add_springs(Model& model) {
  model.joint_springs = {{"back", 1, 60, 0.5, 0, {}, {}, JointCoordinate::displacement},
                         {"coil", 1, 0.6, 0.005, 0, {}, {}, JointCoordinate::angle}};
}
void add_limits(Model& model) {
  JointLimit stop;
  stop.name = "stop", stop.joint = 1, stop.coordinate = JointCoordinate::displacement;
  stop.lower = -0.1, stop.upper = 0.1, stop.stiffness = 3000, stop.damping = 4, stop.exponent = 1.5;
  model.joint_limits = {stop};
}
void add_friction(Model& model) {
  model.joint_frictions.resize(3);
  for (int i = 0; i < 3; ++i) {
    JointFriction& f = model.joint_frictions[static_cast<std::size_t>(i)];
    f.name = "friction." + std::to_string(i), f.joint = i == 0 ? 0 : 1;
    f.effort = 0.02, f.lever = i == 2 ? 0.2 : 0.2 * 0.02, f.stiffness = i == 2 ? 400 : 5;
  }
  model.joint_frictions[1].coordinate = JointCoordinate::angle;
  model.joint_frictions[2].coordinate = JointCoordinate::displacement;
}
void add_bushing(Model& model) {
  Bushing rubber;
  rubber.name = "rubber", rubber.body[0] = 1, rubber.body[1] = 2;
  const Vec3 at{0.55, 0.15, 0.02};
  for (int i = 0; i < 2; ++i) {
    const Body& body = model.bodies[static_cast<std::size_t>(rubber.body[i])];
    rubber.point[i] = transposed(rotation_matrix(body.orientation)) * (at - body.position);
    rubber.marker[i] = conjugate(body.orientation);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    rubber.stiffness[k][k] = k < 3 ? 500 : 4;
    rubber.damping[k][k] = k < 3 ? 3 : 0.02;
  }
  rubber.preload = {1, -0.5, 2, 0.05, 0, -0.02};
  model.bushings = {rubber};
}

struct Balance {
  Real gap = 0;  // largest error of the energy balance [J]
  Real dissipated = 0, driven = 0, stored = 0;
};

Balance balance_of(const Model& model, Real h) {
  MultibodyRun run(model, 1e-11);
  const Real start = energy(run);
  Balance balance;
  for (int i = 0; i < static_cast<int>(std::lround(1 / h)); ++i) {
    run.step(h);
    balance.gap = std::max(balance.gap, std::abs(energy(run) - start));
    balance.stored = std::max(balance.stored, run.multibody.energies(run.state, run.time).elastic);
  }
  balance.dissipated = run.state.dissipated, balance.driven = run.state.driver_work;
  return balance;
}

// Over four steps, each half of the one before. dissipated, driven, stored: at least [J].
void check_order(const Model& model, Real dissipated, Real driven, Real stored) {
  Balance before = balance_of(model, 2e-3);
  const Real first = before.gap;
  for (const Real h : {1e-3, 5e-4, 2.5e-4}) {
    const Balance balance = balance_of(model, h);
    CHECK(measured("crane/halved", "", in_range(before.gap / balance.gap, 3.6, 4.4)));
    before = balance;
  }
  CHECK(measured("crane/order", "", at_least(std::log2(first / before.gap) / 3, 1.95)));
  CHECK(before.gap < 1e-5);
  CHECK(before.dissipated >= dissipated);
  CHECK(before.driven >= driven);
  CHECK(before.stored >= stored);
}

}  // namespace

TEST_CASE("the ledger closes to second order with each kind of element, and with all of them") {
  Model model = crane();
  SECTION("motors") {
    add_motors(model);
    check_order(model, 0, 16, 0);
  }
  SECTION("springs") {
    add_springs(model);
    check_order(model, 0.1, 0, 0.3);
  }
  SECTION("stops") {
    add_limits(model);
    check_order(model, 0.4, 0, 0.5);
  }
  SECTION("friction that the joints' reactions load") {
    add_friction(model);
    check_order(model, 0.9, 0, 1e-3);
  }
  SECTION("a bushing") {
    add_bushing(model);
    check_order(model, 0.4, 0, 0.3);
  }
  SECTION("all of them") {
    add_motors(model), add_springs(model), add_limits(model), add_friction(model), add_bushing(model);
    check_order(model, 2.5, 25, 1);
  }
}
