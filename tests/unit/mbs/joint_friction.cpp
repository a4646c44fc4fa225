// Friction of joints: its derivatives in sticking and sliding, and that no step generates energy.
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "mbs/hht_method.hpp"
#include "mbs/joint_laws.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/spatial_run.hpp"
#include "unit/mbs/differences.hpp"
#include "unit/mbs/probe.hpp"

using namespace scree;

namespace {

JointFriction friction_of(int joint, Real effort, Real lever) {
  JointFriction friction;
  friction.name = "friction", friction.joint = joint;
  friction.effort = effort, friction.lever = lever;
  friction.stiffness = 300, friction.damping = 4;
  friction.static_ratio = 1.4, friction.stribeck_rate = 2;
  return friction;
}

Model in_the_plane() {
  Model model = empty_model();
  model.integrator.hht_alpha = -0.2;
  model.bodies = {paper_disc("one", 0.3, -0.2), paper_disc("two", 1.1, 0.5)};
  model.bodies[0].velocity = {0.4, -0.9, 0}, model.bodies[0].angular_velocity = 1.3;
  model.bodies[1].velocity = {-0.6, 0.8, 0}, model.bodies[1].angular_velocity = -2.1;
  model.joints = {ground_pin("pin", 0, {0.1, 0.2, 0}, {0.3, -0.1, 0}),
                  joint_at(JointKind::translational, "slide", 0, 1, {0.31, -0.17, 0}, {-0.23, 0.12, 0})};
  model.joints[1].axis = {0.6, 0.8, 0};
  model.joint_frictions = {friction_of(0, 0.1, 0.3), friction_of(1, 0, 0.5)};
  return model;
}

Model in_space() {
  Model model = spatial_model(-0.2);
  model.bodies = {
      spatial_body("one", 1.2, {0.3, 0.4, 0.5}, {0.35, -0.25, 0.1}, exponential({0.3, -0.8, 0.5})),
      spatial_body("two", 0.8, {0.2, 0.35, 0.3}, {1.2, 0.6, -0.4}, exponential({-0.7, 0.2, 1.1}))};
  model.bodies[0].velocity = {0.4, -0.9, 0.3}, model.bodies[0].spin = {1.3, -0.4, 0.8};
  model.bodies[1].velocity = {-0.6, 0.8, 0.5}, model.bodies[1].spin = {-2.1, 0.9, 0.7};
  model.joints = {joint_at(JointKind::translational, "slide", 0, 1, {0.2, -0.3, 0.15}, {-0.1, 0.25, 0.3})};
  model.joints[0].marker[0] = exponential({0.4, 0.9, -0.3});
  model.joints[0].marker[1] = exponential({-0.2, 0.5, 0.6});
  model.joint_frictions = {friction_of(0, 0.1, 0.4)};
  return model;
}

// Newton's matrix against differences of the residual, at an iterate off the prediction.
void check_matrix(const Model& model, const std::vector<Real>& memory) {
  Probe probe(model);
  HhtMethod method(probe.system, model.integrator.hht_alpha, probe.position, probe.velocity);
  MultibodyState state;
  state.position = probe.position, state.velocity = probe.velocity, state.multipliers = probe.multipliers;
  const std::size_t n = state.velocity.size(), size = n + state.multipliers.size();
  for (std::size_t i = 0; i < n; ++i) {
    state.acceleration.push_back(std::cos(2.0 * static_cast<Real>(i)));
    state.force.push_back(0.3 * std::sin(1.0 + static_cast<Real>(i)));
  }
  constexpr Real kStep = 0.1;
  const SystemInstant start{0.1, state.position, state.velocity, &state.multipliers};
  probe.system.joint_forces().open_step(probe.system.poses_at(start), start, kStep, memory);
  const std::vector<Real> off(size, 0.3), none(size, 0);
  const auto residual_at = [&](const std::vector<Real>& correction) {
    method.predict(state, 0.1, kStep);
    method.evaluate_residual();
    method.apply_correction(off);
    method.apply_correction(correction);
    method.evaluate_residual();
    return method.residual();
  };
  Matrix numeric = differences(residual_at, none, 1e-3);
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

}  // namespace

TEST_CASE("with friction Newton's matrix is the derivative of the residual, that by the reactions included") {
  for (Model model : {in_the_plane(), in_space()}) {
    const std::size_t frictions = model.joint_frictions.size();
    for (const Real memory : {0.0, 3.0, -3.0}) {
      INFO("sliding, memory " << memory);
      check_matrix(model, std::vector<Real>(frictions, memory));
    }
    // Soft and strong enough to stick. The factor of the limit is 1 here: clipping of the spring by it has
    // no derivative.
    for (JointFriction& friction : model.joint_frictions)
      friction.effort += 500, friction.static_ratio = 1, friction.stribeck_rate = kInfinity;
    INFO("sticking");
    check_matrix(model, std::vector<Real>(frictions, 3));
  }
}

TEST_CASE("over any step friction takes energy, none or some") {
  std::mt19937 random(5);
  const auto number = [&](Real low, Real high) {
    return std::uniform_real_distribution<Real>(low, high)(random);
  };
  int slides = 0, sticks = 0;
  for (int i = 0; i < 20000; ++i) {
    JointFriction friction = friction_of(0, number(0, 2), number(0, 1));
    friction.stiffness = number(1, 100), friction.damping = i % 2 == 0 ? 0 : number(0, 10);
    friction.static_ratio = i % 3 == 0 ? number(1, 3) : 1;
    const std::unique_ptr<JointLaw> law = make_joint_law(friction);
    const LawStep step{{0, number(-1, 1), number(-3, 3), number(0, 5)}, number(-6, 6), number(0.01, 1)};
    const CoordinateInstant end{step.h, number(-1, 1), number(-3, 3), number(0, 5)};
    const Real first = law->effort(step.start, step.memory).effort;
    const JointEffort last = law->step_effort(step, end);
    const Real work = (first + last.effort) / 2 * (end.value - step.start.value);
    const Real memory = law->memory_after(step, end);
    const Real lost = -work - (law->energy(end.value, memory) - law->energy(step.start.value, step.memory));
    REQUIRE(lost > -1e-12);
    REQUIRE(std::abs(memory) <=
            friction.static_ratio * (friction.effort + friction.lever * end.load) + 1e-12);
    (last.by_load == 0 ? sticks : slides) += 1;
  }
  CHECK(slides > 1000);
  CHECK(sticks > 1000);
}
