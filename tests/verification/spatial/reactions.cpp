// Reactions of every spatial joint against the balance of its free bodies.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "deck/choices.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

constexpr Real kAlpha = -0.1, kEnd = 0.4, kDistance = 0.3;
constexpr Vec3 kGravity3{0, 0, -9.81};

struct Wrench {
  Vec3 force, torque;  // about the centre of mass, global
};

TimeFunction sine(Real amplitude, Real frequency) {
  TimeFunction f;
  f.kind = TimeFunctionKind::sine;
  f.amplitude = amplitude, f.frequency = frequency;
  return f;
}
Real sine_at(Real amplitude, Real frequency, Real t) {
  return amplitude * std::sin(2 * M_PI * frequency * t);
}

// Joint 0 is spherical, between body 0 and the ground; joint 1 is of this kind, between bodies 1 and 0. A
// force off its centre and a torque act on body 1.
Model hanging_pair(JointKind kind) {
  Model model = spatial_model(kAlpha);
  model.consistent_velocities = true;
  model.bodies = {
      spatial_body("one", 1.2, {0.03, 0.04, 0.05}, {0.1, 0.05, -0.4}, exponential({0.3, -0.8, 0.5})),
      spatial_body("two", 0.8, {0.02, 0.035, 0.03}, {}, exponential({-0.7, 0.2, 1.1}))};
  for (Body& body : model.bodies) body.inertia_tensor.xy = 0.003, body.inertia_tensor.yz = -0.002;
  Body &one = model.bodies[0], &two = model.bodies[1];
  one.velocity = {0.4, -0.9, 0.3}, one.spin = {1.3, -0.4, 0.8};
  two.velocity = {-0.6, 0.8, 0.5}, two.spin = {-2.1, 0.9, 1.7};
  Joint joint = joint_at(kind, word_of(kind), 0, 1, {0.2, -0.3, 0.15}, {-0.1, 0.25, 0.3});
  joint.distance = kDistance, joint.lead = 0.2;
  joint.marker[0] = exponential({0.4, 0.9, -0.3});
  Quaternion second = joint.marker[0];  // in the frame of body 0
  if (kind == JointKind::perpendicular) second = second * exponential({M_PI / 2, 0, 0});
  if (kind == JointKind::spherical || kind == JointKind::distance) second = exponential({1, 2, 0.5});
  joint.marker[1] = conjugate(two.orientation) * one.orientation * second;
  const Mat3 a1 = rotation_matrix(one.orientation), a2 = rotation_matrix(two.orientation);
  const Vec3 apart = kind == JointKind::distance ? Vec3{0, 0.18, -0.24} : Vec3{};
  two.position = one.position + a1 * joint.point[0] + apart - a2 * joint.point[1];
  const Vec3 top{0.05, 0.1, 0.3};
  model.joints = {joint_at(JointKind::spherical, "ball", kGround, 0, one.position + a1 * top, top), joint};
  AppliedForce push{"push", 1, {0.2, -0.1, 0.1}, sine(3, 2), sine(-2, 3), {}};
  push.fz = sine(4, 1);
  AppliedForce turn{"turn", 1, {}, {}, {}, sine(0.3, 2)};
  turn.torque_x = sine(0.2, 3), turn.torque_y = sine(-0.4, 1);
  model.applied_forces = {push, turn};
  return model;
}

constexpr Real kStroke = 0.1, kFrequency = 1.5;

// Starts at the joint's coordinate at t = 0.
TimeFunction driven_motion(JointKind kind) {
  TimeFunction f = sine(kStroke, kFrequency);
  if (kind == JointKind::distance) f.value = kDistance;
  return f;
}
Real driven_rate(Real t) {
  const Real w = 2 * M_PI * kFrequency;
  return kStroke * w * std::cos(w * t);
}

// Force and torque applied to body 1.
Wrench applied(Real t, const BodyMotion& body) {
  const Vec3 force{sine_at(3, 2, t), sine_at(-2, 3, t), sine_at(4, 1, t)};
  const Vec3 torque{sine_at(0.2, 3, t), sine_at(-0.4, 1, t), sine_at(0.3, 2, t)};
  return {force, torque + cross(rotation_matrix(body.orientation) * Vec3{0.2, -0.1, 0.1}, force)};
}

struct Balance {
  std::vector<BodyMotion> motion;
  std::array<Wrench, 2> wrench;
  Wrench reaction,
      driver;  // of joint 1 with its driver, and of the driver alone, on body 1 about the joint's point
};

// All forces on each body: weight, applied ones, and the reactions of the run, with their lever arms.
Balance balance_of(const MultibodyRun& run, const Model& model) {
  Balance b;
  b.motion = run.multibody.motion(run.state);
  for (std::size_t i = 0; i < 2; ++i) b.wrench[i].force = model.bodies[i].mass * kGravity3;
  const Wrench load = applied(run.time, b.motion[1]);
  b.wrench[1].force += load.force, b.wrench[1].torque += load.torque;
  const auto reactions = run.multibody.reactions(run.state, run.time);
  const auto point = [&](std::size_t body, std::size_t joint, int end) {
    return b.motion[body].position +
           rotation_matrix(b.motion[body].orientation) * model.joints[joint].point[end];
  };
  const auto act = [&](std::size_t body, Real sign, const Reaction& r, Vec3 at) {
    b.wrench[body].force += sign * r.force;
    b.wrench[body].torque += sign * (r.torque + cross(at - b.motion[body].position, r.force));
  };
  act(0, 1, reactions[0], point(0, 0, 1));
  for (std::size_t k = 1; k < reactions.size(); ++k) {
    act(1, 1, reactions[k], point(1, 1, 1));
    act(0, -1, reactions[k], point(1, 1, 1));
    b.reaction.force += reactions[k].force, b.reaction.torque += reactions[k].torque;
    if (k == 2) b.driver = {reactions[k].force, reactions[k].torque};
  }
  return b;
}

struct Momentum {
  Vec3 linear, angular;  // about the origin
};
Momentum momentum_of(const Balance& b, const Model& model) {
  Momentum sum;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 p = model.bodies[i].mass * b.motion[i].velocity;
    sum.linear += p;
    sum.angular += cross(b.motion[i].position, p) + rotation_matrix(b.motion[i].orientation) *
                                                        (model.bodies[i].inertia_tensor * b.motion[i].spin);
  }
  return sum;
}

// The components of the reaction along the axes of the joint's marker on the first body that the joint can
// transmit.
struct Carried {
  JointKind kind;
  std::string_view force, torque;
};
constexpr Carried kCarried[] = {{JointKind::revolute, "xyz", "xy"},
                                {JointKind::translational, "xy", "xyz"},
                                {JointKind::fixed, "xyz", "xyz"},
                                {JointKind::distance, "xyz", ""},
                                {JointKind::spherical, "xyz", ""},
                                {JointKind::cylindrical, "xy", "xy"},
                                {JointKind::screw, "xyz", "xyz"},
                                {JointKind::universal, "xyz", "yz"},
                                {JointKind::constant_velocity, "xyz", "xyz"},
                                {JointKind::planar, "z", "xy"},
                                {JointKind::point_on_line, "xy", ""},
                                {JointKind::point_on_plane, "z", ""},
                                {JointKind::parallel, "", "xy"},
                                {JointKind::perpendicular, "", "xy"},
                                {JointKind::orientation, "", "xyz"}};
static_assert(std::size(kCarried) == std::size(kWords<JointKind>));

std::array<Real, 3> components(Vec3 v) { return {v.x, v.y, v.z}; }

// Largest gaps over a run.
struct Gaps {
  Real force = 0, torque = 0;   // of the bodies' balance [N, N m]
  Real carried = 0;             // of components that the joint without a driver cannot transmit [N, N m]
  Real power = 0;               // power of the reaction on the joint's own motion, less the driver's [W]
  Real impulse = 0, swing = 0;  // of momentum and angular momentum [N s, N m s]
  Real most = 0;                // the reaction's size [N, N m]
};

// M a = H, with H the forces and torques at the instant, the torque less w x J w and along the body's axes.
void compare_instant(const Model& model, const MultibodyRun& run, const Balance& b, Gaps& gaps) {
  const MultibodyState now = run.multibody.at_instant(run.state, run.time);
  for (std::size_t i = 0; i < 2; ++i) {
    const Real* a = &now.acceleration[6 * i];
    const Mat3 inertia = full(model.bodies[i].inertia_tensor);
    const Vec3 spin = b.motion[i].spin,
               torque = transposed(rotation_matrix(b.motion[i].orientation)) * b.wrench[i].torque -
                        cross(spin, inertia * spin);
    gaps.force =
        std::max(gaps.force, norm(model.bodies[i].mass * Vec3{a[0], a[1], a[2]} - b.wrench[i].force));
    gaps.torque = std::max(gaps.torque, norm(inertia * Vec3{a[3], a[4], a[5]} - torque));
  }
}

// Power of the driver's reaction: its component along the coordinate times the coordinate's rate. second:
// the second body's arm of a universal joint.
Real drive_power(const Model& model, const Wrench& driver, const Mat3& marker, Vec3 second, Vec3 apart,
                 Real t) {
  if (model.drivers.empty()) return 0;
  switch (*model.drivers[0].coordinate) {
    case JointCoordinate::angle:
      return (marker * driver.torque).z * driven_rate(t);
    case JointCoordinate::displacement:
      return (marker * driver.force).z * driven_rate(t);
    case JointCoordinate::length:
      return dot(driver.force, apart) / norm(apart) * driven_rate(t);
    case JointCoordinate::angle_1:
      return (marker * driver.torque).x * driven_rate(t);
    case JointCoordinate::angle_2:
      return dot(driver.torque, second) * driven_rate(t);
  }
  return 0;
}

// Power of the reaction on the joint's own motion, and whether the joint can transmit the reaction.
void check_reaction(const Model& model, const Balance& b, Real t, Gaps& gaps) {
  const Vec3 force = b.reaction.force, torque = b.reaction.torque;
  gaps.most = std::max(gaps.most, norm(force) + norm(torque));
  const BodyMotion &one = b.motion[0], &two = b.motion[1];
  const Mat3 a1 = rotation_matrix(one.orientation), a2 = rotation_matrix(two.orientation);
  const Vec3 arm = a2 * model.joints[1].point[1], reach = two.position + arm - one.position;
  const Vec3 w1 = a1 * one.spin, w2 = a2 * two.spin;
  const Vec3 slip = two.velocity + cross(w2, arm) - one.velocity - cross(w1, reach);
  const Mat3 marker = transposed(a1 * rotation_matrix(model.joints[1].marker[0]));
  const Vec3 second = a2 * (rotation_matrix(model.joints[1].marker[1]) * Vec3{0, 1, 0});
  const Real drive = drive_power(model, b.driver, marker, second, reach - a1 * model.joints[1].point[0], t);
  gaps.power = std::max(gaps.power, std::abs(dot(force, slip) + dot(torque, w2 - w1) - drive));
  if (!model.drivers.empty()) return;
  const auto& carried = *std::find_if(std::begin(kCarried), std::end(kCarried),
                                      [&](const Carried& c) { return c.kind == model.joints[1].kind; });
  for (const auto& [parts, axes] :
       {std::pair{components(marker * force), carried.force}, {components(marker * torque), carried.torque}})
    for (std::size_t k = 0; k < 3; ++k)
      if (axes.find("xyz"[k]) == std::string_view::npos)
        gaps.carried = std::max(gaps.carried, std::abs(parts[k]));
}

Gaps gaps_of(const Model& model, Real h) {
  MultibodyRun run(model, 1e-12);
  Gaps gaps;
  run.step(h);  // from the corrected start
  Balance before = balance_of(run, model);
  const Momentum start = momentum_of(before, model);
  Momentum given;
  for (int i = 1; i < static_cast<int>(std::lround(kEnd / h)); ++i) {
    run.step(h);
    const Balance after = balance_of(run, model);
    compare_instant(model, run, after, gaps);
    for (const Balance* b : std::array<const Balance*, 2>{&before, &after})
      for (std::size_t k = 0; k < 2; ++k) {
        given.linear += (h / 2) * b->wrench[k].force;
        given.angular += (h / 2) * (b->wrench[k].torque + cross(b->motion[k].position, b->wrench[k].force));
      }
    const Momentum now = momentum_of(after, model);
    gaps.impulse = std::max(gaps.impulse, norm(now.linear - start.linear - given.linear));
    gaps.swing = std::max(gaps.swing, norm(now.angular - start.angular - given.angular));
    check_reaction(model, after, run.time, gaps);
    before = after;
  }
  return gaps;
}

void check_gaps(const Model& model) {
  const Gaps coarse = gaps_of(model, 2e-3), fine = gaps_of(model, 1e-3);
  CHECK(fine.most > 0.8);
  for (const Real gap : {fine.force, fine.torque})
    CHECK(measured("reactions/balance", "", at_most(gap / std::max(Real(1), fine.most), 1e-12)));
  CHECK(fine.carried < 1e-12);
  // The errors of the velocities permitted by the position constraints are of second order.
  CHECK(fine.power < 4e-4 * fine.most);
  CHECK((coarse.power / fine.power > 3.8 || coarse.power < 1e-10));
  for (const Real ratio : {coarse.impulse / fine.impulse, coarse.swing / fine.swing})
    CHECK(measured("reactions/halved", "", in_range(ratio, 3.9, 4.1)));
}

}  // namespace

TEST_CASE("the reactions of every joint in space balance what acts on its bodies, and do no work") {
  for (const Word<JointKind>& kind : kWords<JointKind>) {
    INFO(kind.text);
    check_gaps(hanging_pair(kind.value));
  }
}

TEST_CASE("with a driver they balance it, too, and their power is its own") {
  int drivers = 0;
  for (const Word<JointKind>& kind : kWords<JointKind>)
    for (const JointCoordinate coordinate : coordinates_of(kind.value)) {
      INFO(kind.text << " " << word_of(coordinate));
      Model model = hanging_pair(kind.value);
      model.drivers.push_back({"driver", 1, driven_motion(kind.value), coordinate});
      check_gaps(model);
      ++drivers;
    }
  CHECK(drivers == 9);
}
