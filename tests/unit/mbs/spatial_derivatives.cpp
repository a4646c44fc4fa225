// Analytic derivatives between spatial bodies against central differences: every joint, driver and force
// element, between two bodies and between body and ground. Poses are changed by displace, as in steps.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mbs/hht_method.hpp"
#include "mbs/rigid_body_system.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "support/catch.hpp"
#include "support/spatial_run.hpp"
#include "unit/mbs/differences.hpp"
#include "unit/mbs/efforts.hpp"
#include "unit/mbs/probe.hpp"

using namespace scree;

namespace {

// Neither the poses nor the velocities satisfy any constraint: the derivatives hold everywhere.
Model two_bodies() {
  Model model = spatial_model(-0.2);
  model.bodies = {
      spatial_body("one", 1.2, {0.3, 0.4, 0.5}, {0.35, -0.25, 0.1}, exponential({0.3, -0.8, 0.5})),
      spatial_body("two", 0.8, {0.2, 0.35, 0.3}, {1.2, 0.6, -0.4}, exponential({-0.7, 0.2, 1.1}))};
  for (Body& body : model.bodies) body.inertia_tensor.xy = 0.03, body.inertia_tensor.yz = -0.02;
  model.bodies[0].velocity = {0.4, -0.9, 0.3}, model.bodies[0].spin = {1.3, -0.4, 0.8};
  model.bodies[1].velocity = {-0.6, 0.8, 0.5}, model.bodies[1].spin = {-2.1, 0.9, 0.7};
  return model;
}

TimeFunction sine() {
  TimeFunction f;
  f.kind = TimeFunctionKind::sine;
  f.value = 0.7, f.amplitude = 0.2, f.frequency = 0.8, f.phase = 0.4;
  return f;
}

Joint joint_between(JointKind kind, int first, int second) {
  Joint joint = joint_at(kind, word_of(kind), first, second, {0.2, -0.3, 0.15}, {-0.1, 0.25, 0.3});
  joint.distance = 0.9, joint.lead = 0.4;
  // The frames are rotated against each other by half a radian about an arbitrary axis.
  const auto orientation = [](int body) {
    return body == kGround ? Quaternion{} : two_bodies().bodies[static_cast<std::size_t>(body)].orientation;
  };
  joint.marker[0] = exponential({0.4, 0.9, -0.3});
  joint.marker[1] =
      conjugate(orientation(second)) * orientation(first) * joint.marker[0] * exponential({0.2, -0.15, 0.4});
  return joint;
}

// All entries of its matrices differ.
Bushing bushing_between(int first, int second) {
  Bushing bushing;
  bushing.name = "bushing";
  bushing.body[0] = first, bushing.body[1] = second;
  bushing.point[0] = {0.2, -0.3, 0.15}, bushing.point[1] = {-0.1, 0.25, 0.3};
  bushing.marker[0] = exponential({0.4, 0.9, -0.3}), bushing.marker[1] = exponential({-0.2, 0.5, 0.6});
  bushing.preload = {1, -2, 3, 0.4, -0.5, 0.6};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) {
      const Real sum = static_cast<Real>(a + b), product = static_cast<Real>(a * b);
      bushing.stiffness[a][b] = (a == b ? 9 : 1) + std::cos(sum + 2 * product);
      bushing.damping[a][b] = (a == b ? 2 : 0) + 0.3 * std::sin(1 + 2 * sum + product);
    }
  return bushing;
}

std::vector<std::pair<std::string, Model>> samples() {
  std::vector<std::pair<std::string, Model>> all;
  for (const auto& [first, second] : {std::pair{0, 1}, {kGround, 1}, {0, kGround}}) {
    const std::string ends = fmt::format(" {} {}", first, second);
    for (const Word<JointKind>& kind : kWords<JointKind>) {
      Model model = two_bodies();
      model.joints = {joint_between(kind.value, first, second)};
      all.emplace_back(std::string(kind.text) + ends, model);
    }
    for (const Word<JointKind>& kind : kWords<JointKind>)
      for (const JointCoordinate coordinate : coordinates_of(kind.value)) {
        Model model = two_bodies();
        model.joints = {joint_between(kind.value, first, second)};
        model.drivers.push_back({"driver", 0, sine(), coordinate});
        const std::string title = std::string(kind.text) + " " + word_of(coordinate) + ends;
        all.emplace_back("driven " + title, model);
        model.drivers.clear();
        add_efforts(model, sine(), coordinate);
        all.emplace_back("efforts on " + title, model);
        if (coordinate == JointCoordinate::length) {
          model.joints[0].telescopes = true;
          all.emplace_back("cylinder" + ends, model);
          continue;
        }
        model = two_bodies();
        model.joints = {joint_between(kind.value, first, second)};
        model.joints.push_back(joint_between(JointKind::cylindrical, kGround, 0));
        for (const JointCoordinate other : {JointCoordinate::angle, JointCoordinate::displacement}) {
          model.couplers = {{"sum", {0, 1}, {1, -0.4}, {coordinate, other}}};
          all.emplace_back("coupled " + title, model);
        }
      }
    Model centred = two_bodies();
    centred.joints = {joint_between(JointKind::translational, first, second)};
    centred.joints[0].point[0] = centred.joints[0].point[1] = {};
    all.emplace_back("translational, centres" + ends, centred);
    Model spring = two_bodies();
    spring.spring_dampers.push_back(
        {"spring", {first, second}, {{0.1, -0.2, 0.3}, {-0.23, 0.12, 0.2}}, 70, 9, 0.4, sine()});
    all.emplace_back("spring" + ends, spring);
    spring.spring_dampers[0].point[0] = spring.spring_dampers[0].point[1] = {};
    all.emplace_back("spring between centres" + ends, spring);
    Model bushing = two_bodies();
    bushing.bushings = {bushing_between(first, second)};
    all.emplace_back("bushing" + ends, bushing);
    Bushing& bare = bushing.bushings[0];
    bare.preload = {1, -2, 3, 0, 0, 0};
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b)
        if (a > 2 || b > 2) bare.stiffness[a][b] = bare.damping[a][b] = 0;
    all.emplace_back("bushing without turns" + ends, bushing);
  }
  for (const bool follows : {false, true}) {
    Model force = two_bodies();
    force.applied_forces.push_back(
        {"push", 1, {0.2, -0.3, 0.1}, sine(), sine(), sine(), follows, sine(), sine(), {}});
    force.applied_forces.back().axes = exponential({0.4, -1.0, 0.3});  // of those that follow
    force.applied_forces[0].fy.value = -1.3;
    all.emplace_back(follows ? "following force" : "force", force);
  }
  return all;
}

}  // namespace

TEST_CASE("in space stiffness and damping are the derivatives of the forces") {
  for (const auto& [name, model] : samples()) {
    INFO(name);
    Probe probe(model);
    const int n = probe.system.coordinates();
    probe.evaluate(probe.position, probe.velocity);
    probe.system.differentiate({kTime, probe.position, probe.velocity},
                               {probe.still, probe.still, probe.multipliers}, probe.derivatives);
    check_equal(
        dense(probe.derivatives.stiffness, n, n),
        differences([&](const auto& u) { return probe.force(probe.moved(u), probe.velocity); }, probe.still));
    check_equal(dense(probe.derivatives.damping, n, n),
                differences([&](const auto& v) { return probe.force(probe.position, v); }, probe.velocity));
  }
}

TEST_CASE("in space the constraint Jacobian and right-hand sides are the derivatives of the constraints") {
  for (const auto& [name, model] : samples()) {
    INFO(name);
    Probe probe(model);
    const auto constraint = [&](const std::vector<Real>& u, Real t) {
      probe.evaluate(probe.moved(u), probe.velocity, t);
      return probe.terms.constraint;
    };
    // Under constant velocities, w in the body's frame: Phi' = Phi_q v - velocity_rhs, Phi'' =
    // -acceleration_rhs.
    const auto along = [&](Real s) {
      std::vector<Real> u = probe.velocity;
      for (Real& x : u) x *= s;
      return constraint(u, kTime + s);
    };
    const Matrix numeric = differences([&](const auto& u) { return constraint(u, kTime); }, probe.still);
    constexpr Real kStep = 1e-4;  // truncation of some 1e-7, round-off of second differences is as large
    const std::vector<Real> before = along(-kStep), now = along(0), after = along(kStep);
    probe.evaluate(probe.position, probe.velocity);
    const SystemInstant at{kTime, probe.position, probe.velocity};
    check_equal(
        dense(probe.terms.constraint_jacobian, probe.system.constraints(), probe.system.coordinates()),
        numeric);
    std::vector<Real> rate(now.size()), second(now.size());
    probe.system.velocity_rhs(at, rate);
    probe.system.acceleration_rhs(at, second);
    for (Real& r : rate) r = -r;
    probe.terms.constraint_jacobian.multiply(1, probe.velocity, rate);
    for (std::size_t j = 0; j < now.size(); ++j) {
      CHECK(near(rate[j], (after[j] - before[j]) / (2 * kStep), {.absolute = 3e-7}));
      CHECK(near(-second[j], (after[j] - 2 * now[j] + before[j]) / (kStep * kStep),
                 {.relative = 3e-7, .absolute = 1e-6}));
    }
  }
}

TEST_CASE("in space the reaction of a joint is what its rows do to the second body") {
  for (const auto& [name, model] : samples()) {
    if (model.joints.empty() || model.joints[0].body[1] == kGround || !model.drivers.empty() ||
        !model.couplers.empty() || model.joints[0].telescopes)  // a cylinder has no rows
      continue;
    INFO(name);
    Probe probe(model);
    const SystemInstant at{kTime, probe.position, probe.velocity, &probe.multipliers};
    probe.evaluate(probe.position, probe.velocity);
    std::vector<Real> force(probe.velocity.size(), 0);
    probe.terms.constraint_jacobian.multiply_transposed(-1, probe.multipliers, force);
    const std::vector<Real> memory(static_cast<std::size_t>(memory_count(model)), 0);
    const auto reaction = probe.system.reactions(at, memory)[0];
    const Real* f = &force[6];
    const Mat3 a = rotation_matrix(model.bodies[1].orientation);
    const Vec3 about_centre = reaction.torque + cross(a * model.joints[0].point[1], reaction.force);
    CHECK(near(reaction.force, Vec3{f[0], f[1], f[2]}, {.absolute = 1e-13}));
    CHECK(near(about_centre, a * Vec3{f[3], f[4], f[5]}, {.absolute = 1e-13}));
  }
}

TEST_CASE("in space Newton's matrix is the derivative of the residual, tangent included") {
  Model model = two_bodies();
  model.joints = {joint_between(JointKind::revolute, 0, 1)};
  model.spring_dampers.push_back(
      {"spring", {kGround, 0}, {{2, 1, 0.5}, {-0.23, 0.12, 0.2}}, 70, 9, 0.4, sine()});
  Probe probe(model);
  HhtMethod method(probe.system, model.integrator.hht_alpha, probe.position, probe.velocity);
  MultibodyState state;
  state.position = probe.position, state.velocity = probe.velocity, state.multipliers = probe.multipliers;
  const std::size_t n = state.velocity.size(), size = n + state.multipliers.size();
  for (std::size_t i = 0; i < n; ++i) {
    state.acceleration.push_back(std::cos(2.0 * static_cast<Real>(i)));
    state.force.push_back(0.3 * std::sin(1.0 + static_cast<Real>(i)));
  }
  constexpr Real kStep = 0.2;  // rotates the bodies by 0.3 to 0.5 rad: T is not 1
  // An iterate off the prediction, then a correction of the pose's change over beta h^2, and of lambda.
  std::vector<Real> off(size, 0.3);
  const auto residual_at = [&](const std::vector<Real>& correction) {
    method.predict(state, 0.1, kStep);
    method.evaluate_residual();
    method.apply_correction(off);
    method.apply_correction(correction);
    method.evaluate_residual();
    return method.residual();
  };
  const std::vector<Real> none(size, 0);
  Matrix numeric = differences(residual_at, none, 0.01);
  for (std::vector<Real>& row : numeric)
    for (Real& x : row) x = -x;  // corrections are subtracted
  residual_at(none);
  std::vector<Real> values(method.pattern().column.size());
  method.newton_matrix(values);
  Matrix analytic(size, std::vector<Real>(size, 0));
  for (std::size_t i = 0; i < size; ++i)
    for (int k = method.pattern().row_start[i]; k < method.pattern().row_start[i + 1]; ++k)
      analytic[i][static_cast<std::size_t>(method.pattern().column[static_cast<std::size_t>(k)])] =
          values[static_cast<std::size_t>(k)];
  check_equal(analytic, numeric);
}
