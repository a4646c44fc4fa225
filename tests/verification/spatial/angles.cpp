// Angles of spatial joints as coordinates: counted revolutions, drivers, motors and springs on them.
#include <bit>
#include <cmath>
#include <cstdint>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

TimeFunction ramp(Real rate) {
  TimeFunction f;
  f.kind = TimeFunctionKind::ramp, f.rate = rate;
  return f;
}

TimeFunction sine(Real amplitude, Real frequency) {
  TimeFunction f;
  f.kind = TimeFunctionKind::sine, f.amplitude = amplitude, f.frequency = frequency;
  return f;
}

constexpr Vec3 kAxis{2.0 / 3, -1.0 / 3, 2.0 / 3};

// A wheel on a revolute joint along kAxis through its centre; records all coordinates.
Model wheel(JointKind kind = JointKind::revolute) {
  Model model = spatial_model(-0.05);
  model.consistent_velocities = true;
  model.bodies = {spatial_body("wheel", 2, {0.02, 0.03, 0.04}, {})};
  model.bodies[0].inertia_tensor.xy = 0.004, model.bodies[0].inertia_tensor.yz = -0.003;
  model.joints = {joint_at(kind, "hinge", kGround, 0, {}, {})};
  const Vec3 across = (1 / std::sqrt(Real(5))) * Vec3{1, 2, 0};
  model.joints[0].marker[0] = model.joints[0].marker[1] = marker_along(kAxis, across);
  model.output.history_coordinates = 10;
  return model;
}

Real axial_inertia(const Model& model) { return dot(kAxis, model.bodies[0].inertia_tensor * kAxis); }

std::vector<JointReading> readings(const MultibodyRun& run) {
  return run.multibody.joint_readings(run.state, run.time);
}

bool same_bits(const std::vector<Real>& a, const std::vector<Real>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](Real x, Real y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

}  // namespace

// 50 revolutions up and back, 150 of the gear that an internal gear drives; interrupted and continued on the
// way, and after rejected steps.
TEST_CASE("an angle counts fifty revolutions and back, and continues after a restart") {
  Model model = wheel();
  const Real amplitude = 100 * M_PI;
  model.time.end = 2;
  model.drivers = {{"drive", 0, sine(amplitude, 0.25)}};
  model.bodies.push_back(spatial_body("small", 0.2, {1e-3, 1e-3, 2e-3}, {1, 0, 0}));
  model.joints.push_back(joint_at(JointKind::revolute, "second", kGround, 1, {1, 0, 0}, {}));
  model.couplers = {{"gear", {0, 1}, {1, -1.0 / 3}}};
  constexpr Real kStep = 1e-3;
  MultibodyRun run(model, 1e-11);
  MultibodyState left;
  for (int i = 0; i < 2000; ++i) {
    if (i % 50 == 0) run.multibody.predict(run.state, run.time, 1.5 * kStep);  // a step that is not accepted
    run.step(kStep);
    if (i == 699) left = run.state;
    const std::vector<JointReading> c = readings(run);
    const Real angle = amplitude * std::sin(M_PI / 2 * run.time);
    REQUIRE(measured("angles/turns", "rad", near(c.at(0).value, angle, {.absolute = 1e-9})));
    REQUIRE(measured("angles/geared turns", "rad", near(c.at(1).value, 3 * angle, {.absolute = 3e-9})));
    REQUIRE(near(c.at(1).rate, 3 * c.at(0).rate, {.absolute = 1e-3}));
  }
  MultibodyRun again(model, 1e-11);
  again.state = left, again.time = 700 * kStep;
  for (int i = 0; i < 1300; ++i) {
    again.step(kStep);
    again.time = (701 + i) * kStep;
  }
  CHECK(same_bits(again.state.position, run.state.position));
  CHECK(same_bits(again.state.multipliers, run.state.multipliers));
}

// Universal joints at both ends of a shaft that is bent by beta: tan(b) = tan(a) cos(beta) for the shaft in
// the middle; the last one rotates as the first, since the arms of the middle one are coplanar.
TEST_CASE("a double Hooke shaft rotates by its closed form") {
  constexpr Real kBend = 0.6, kRate = 20;
  const Vec3 along{std::cos(kBend), std::sin(kBend), 0}, across{-std::sin(kBend), std::cos(kBend), 0},
      up{0, 0, 1};
  Model model = spatial_model(-0.05);
  model.consistent_velocities = true, model.output.history_coordinates = 10;
  const Vec3 end = Real(0.5) * along;
  model.bodies = {spatial_body("first", 1, {0.01, 0.02, 0.02}, {-0.2, 0, 0}),
                  spatial_body("middle", 1, {0.01, 0.02, 0.02}, Real(0.5) * end),
                  spatial_body("last", 1, {0.03, 0.03, 0.03}, end + Vec3{0.2, 0, 0})};
  model.joints = {joint_at(JointKind::revolute, "in", kGround, 0, {-0.2, 0, 0}, {}),
                  joint_at(JointKind::universal, "one", 0, 1, {0.2, 0, 0}, Real(-0.5) * end),
                  joint_at(JointKind::universal, "two", 1, 2, Real(0.5) * end, {-0.2, 0, 0}),
                  joint_at(JointKind::cylindrical, "out", kGround, 2, end + Vec3{0.2, 0, 0}, {})};
  for (const std::size_t j : {0, 3})
    model.joints[j].marker[0] = model.joints[j].marker[1] = marker_along({1, 0, 0}, {0, 1, 0});
  const auto frame = [](Vec3 x, Vec3 y) { return marker_along(cross(x, y), x); };
  model.joints[1].marker[0] = model.joints[1].marker[1] = frame(up, across);
  model.joints[2].marker[0] = model.joints[2].marker[1] = frame(across, up);
  model.drivers = {{"drive", 0, ramp(kRate)}};
  MultibodyRun run(model, 1e-12);
  for (int i = 0; i < 1000; ++i) {
    run.step(1e-3);
    const std::vector<JointReading> c = readings(run);
    const Real a = kRate * run.time;
    REQUIRE(c.size() == 7);
    REQUIRE(near(c[0].value, a, {.absolute = 1e-10}));
    REQUIRE(c[5].coordinate == JointCoordinate::angle);
    REQUIRE(measured("angles/shaft", "rad", near(c[5].value, a, {.absolute = 1e-9})));
    REQUIRE(near(c[6].value, 0, {.absolute = 1e-10}));
    const Vec3 arm = rotation_matrix(run.multibody.motion(run.state)[1].orientation) * across;
    const Real b = std::atan2(dot(arm, up), dot(arm, across));
    REQUIRE(near(std::sin(b) * std::cos(a), std::cos(b) * std::sin(a) * std::cos(kBend), {.absolute = 1e-9}));
    // The first joint's cross is inclined to either shaft by the angle whose sine is the component of the
    // other shaft's arm along it; to the first one by kBend at the start, where its angle is 0.
    const Vec3 first = rotation_matrix(exponential(Vec3{a, 0, 0})) * up;
    REQUIRE(near(c[1].value, std::asin(-dot(arm, {1, 0, 0})) - kBend, {.absolute = 1e-9}));
    REQUIRE(near(c[2].value, std::asin(-dot(first, along)), {.absolute = 1e-9}));
  }
}

// Frame 2 is frame 1 rotated about its x by angle_1, then about its own y by angle_2, also beyond whole
// revolutions.
TEST_CASE("the angles of a universal joint determine the pose of its second body") {
  Model model = wheel(JointKind::universal);
  model.drivers = {{"roll", 0, ramp(9), JointCoordinate::angle_1},
                   {"pitch", 0, ramp(-7), JointCoordinate::angle_2}};
  model.time.end = 2;
  const Mat3 frame = rotation_matrix(model.joints[0].marker[0]);
  MultibodyRun run(model, 1e-12);
  MultibodyState left;
  for (int i = 0; i < 2000; ++i) {
    run.step(1e-3);
    if (i == 999) left = run.state;
    const Real roll = 9 * run.time, pitch = -7 * run.time;
    const std::vector<JointReading> c = readings(run);
    REQUIRE(c.size() == 2);
    REQUIRE(near(c[0].value, roll, {.absolute = 1e-9}));
    REQUIRE(near(c[1].value, pitch, {.absolute = 1e-9}));
    REQUIRE(near(c[0].rate, 9, {.absolute = 1e-2}));
    const Mat3 turned = rotation_matrix(exponential(Vec3{roll, 0, 0}) * exponential(Vec3{0, pitch, 0}));
    const Mat3 body = rotation_matrix(run.multibody.motion(run.state)[0].orientation);
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      REQUIRE(near(body * (frame * axis), frame * (turned * axis), {.absolute = 1e-9}));
  }
  MultibodyRun again(model, 1e-12);
  again.state = left, again.time = 1;
  for (int i = 1000; i < 2000; ++i) {
    again.step(1e-3);
    again.time = (i + 1) * 1e-3;
  }
  CHECK(same_bits(again.state.position, run.state.position));
}

// A wheel on the cross's second arm with a spring about either arm: small rotations about the two are
// decoupled, each with its own frequency.
TEST_CASE("springs on the angles of a universal joint have their frequencies") {
  Model model = wheel(JointKind::universal);
  model.bodies[0].inertia_tensor.xy = model.bodies[0].inertia_tensor.yz = 0;
  model.joints[0].marker[0] = model.joints[0].marker[1] = {};
  JointSpring spring;
  spring.joint = 0, spring.name = "one", spring.stiffness = 2, spring.coordinate = JointCoordinate::angle_1;
  model.joint_springs = {spring};
  spring.name = "two", spring.stiffness = 12, spring.coordinate = JointCoordinate::angle_2;
  model.joint_springs.push_back(spring);
  for (JointSpring& s : model.joint_springs) s.free = 0;
  constexpr Real kTurn = 1e-4;
  model.bodies[0].orientation = exponential(Vec3{kTurn, 0, 0}) * exponential(Vec3{0, kTurn, 0});
  MultibodyRun run(model, 1e-12);
  for (int i = 0; i < 1000; ++i) {
    run.step(1e-3);
    const std::vector<JointReading> c = readings(run);
    REQUIRE(near(c.at(0).value, kTurn * std::cos(10 * run.time), {.absolute = 1e-4 * kTurn}));
    REQUIRE(near(c.at(1).value, kTurn * std::cos(20 * run.time), {.absolute = 1e-3 * kTurn}));
  }
}

// J c'' = min(T_limit, T_stall (1 - c' / w_free)).
TEST_CASE("a motor on a torque-speed line with a limit rotates a wheel in space") {
  constexpr Real kStall = 0.5, kFree = 80, kLimit = 0.3, kEnd = 4;
  Model model = wheel();
  Motor motor;
  motor.name = "motor", motor.kind = MotorKind::line, motor.limit = kLimit;
  motor.stall_effort = kStall, motor.free_rate = kFree, motor.command.value = 1;
  model.motors = {motor};
  const Real inertia = axial_inertia(model), knee = kFree * (1 - kLimit / kStall);
  const Real t1 = inertia * knee / kLimit, c1 = knee * t1 / 2, tau = inertia * kFree / kStall;
  const Real rest = 1 - std::exp(-(kEnd - t1) / tau), rate = knee + (kFree - knee) * rest;
  const Real angle = c1 + kFree * (kEnd - t1) - (kFree - knee) * tau * rest;
  REQUIRE(angle > 2 * M_PI * 10);
  MultibodyRun run(model, 1e-12);
  run.steps(2000, kEnd / 2000);
  const JointEffortSample found = run.multibody.joint_efforts(run.state, run.time).at(0);
  CHECK(near(found.coordinate, angle, {.absolute = 1e-4}));
  CHECK(near(found.rate, rate, {.absolute = 1e-4}));
  CHECK(near(found.effort, kStall * (1 - rate / kFree), {.absolute = 1e-6}));
  CHECK(near(found.power, found.effort * found.rate, {.relative = 1e-14}));
  CHECK(near(run.state.driver_work, inertia * rate * rate / 2, {.relative = 1e-4}));
}

TEST_CASE("a torsional spring rotates a wheel in space through many revolutions and back, to second order") {
  const auto error = [](Real h) {
    Model model = wheel();
    model.joint_springs = {{"spring", 0, 3, 0, 40, {}, {}}};  // unloaded at 40 rad: oscillates to 80 rad
    const Real w = std::sqrt(3 / axial_inertia(model));
    MultibodyRun run(model, 1e-12);
    Real worst = 0;
    for (int i = 0; i < static_cast<int>(std::lround(1 / h)); ++i) {
      run.step(h);
      worst = std::max(worst, std::abs(readings(run).at(0).value - 40 * (1 - std::cos(w * run.time))));
    }
    return worst;
  };
  const Real coarse = error(1e-3), fine = error(5e-4);
  CHECK(fine < 0.01);
  CHECK(coarse / fine > 3.8);
  CHECK(coarse / fine < 4.2);
}

TEST_CASE("both coordinates of a cylindrical joint are driven, and a screw by either of its own") {
  Model model = wheel(JointKind::cylindrical);
  model.drivers = {{"turn", 0, ramp(30), JointCoordinate::angle},
                   {"push", 0, sine(0.3, 0.5), JointCoordinate::displacement}};
  MultibodyRun run(model, 1e-12);
  run.steps(500, 1e-3);
  const BodyMotion motion = run.multibody.motion(run.state)[0];
  const Real pushed = 0.3 * std::sin(M_PI * 0.5);
  CHECK(near(motion.position, pushed * kAxis, {.absolute = 1e-11}));
  CHECK(near(readings(run).at(0).value, 15, {.absolute = 1e-10}));
  CHECK(near(readings(run).at(1).value, pushed, {.absolute = 1e-11}));
  for (const JointCoordinate driven : {JointCoordinate::angle, JointCoordinate::displacement}) {
    Model screw = wheel(JointKind::screw);
    screw.joints[0].lead = -0.02;  // left-handed
    const bool turns = driven == JointCoordinate::angle;
    screw.drivers = {{"drive", 0, ramp(turns ? 30 : -30 * 0.02 / (2 * M_PI)), driven}};
    MultibodyRun drive(screw, 1e-12);
    drive.steps(500, 1e-3);
    CHECK(near(readings(drive).at(0).value, 15, {.absolute = 1e-8}));
    CHECK(near(readings(drive).at(1).value, -0.02 * 15 / (2 * M_PI), {.absolute = 1e-11}));
  }
}
