// Analytic derivatives against central differences: every joint, driver and force element, between two bodies
// and between body and ground.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "mbs/hht_method.hpp"
#include "mbs/rigid_body_system.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"
#include "unit/mbs/differences.hpp"
#include "unit/mbs/efforts.hpp"
#include "unit/mbs/probe.hpp"

using namespace scree;

namespace {

Model two_bodies() {
  Model model = empty_model();
  model.bodies.push_back(paper_disc("one", 0.3, -0.2));
  model.bodies.push_back(paper_disc("two", 1.1, 0.5));
  return model;
}

Joint joint_between(JointKind kind, int first, int second) {
  Joint joint;
  joint.name = "joint";
  joint.kind = kind;
  joint.body[0] = first;
  joint.body[1] = second;
  joint.point[0] = {0.31, -0.17, 0};
  joint.point[1] = {-0.23, 0.12, 0};
  joint.axis = {0.6, 0.8, 0};
  joint.distance = 0.9;
  joint.angle_offset = 0.4;
  return joint;
}

TimeFunction sine() {
  TimeFunction function;
  function.kind = TimeFunction::Kind::sine;
  function.value = 0.7;
  function.amplitude = 0.2;
  function.frequency = 0.8;
  function.phase = 0.5;
  return function;
}

Model coupled_bodies() {
  Model model = two_bodies();
  model.joints.push_back(joint_between(JointKind::revolute, kGround, 0));
  model.joints.push_back(joint_between(JointKind::translational, 0, 1));
  model.couplers.push_back({"rack", {0, 1}, {-0.3, 1}});
  return model;
}

// Models with one joint, driver or force element each.
std::vector<std::pair<std::string, Model>> samples() {
  std::vector<std::pair<std::string, Model>> all;
  for (const auto& [first, second] : {std::pair{0, 1}, std::pair{kGround, 1}, std::pair{0, kGround}}) {
    const std::string ends = " " + std::to_string(first) + " " + std::to_string(second);
    for (const JointKind kind :
         {JointKind::revolute, JointKind::translational, JointKind::fixed, JointKind::distance}) {
      Model model = two_bodies();
      model.joints.push_back(joint_between(kind, first, second));
      all.emplace_back("joint " + std::to_string(static_cast<int>(kind)) + ends, model);
      if (kind == JointKind::fixed) continue;
      model.drivers.push_back({"driver", 0, sine()});
      all.emplace_back("driver " + std::to_string(static_cast<int>(kind)) + ends, model);
      if (kind == JointKind::distance) continue;
      model.drivers.clear();
      add_efforts(model, sine());
      all.emplace_back("efforts on joint " + std::to_string(static_cast<int>(kind)) + ends, model);
    }
    Model cylinder = two_bodies();
    cylinder.joints.push_back(joint_between(JointKind::distance, first, second));
    cylinder.joints[0].telescopes = true;
    add_efforts(cylinder, sine());
    all.emplace_back("cylinder" + ends, cylinder);
    Model spring = two_bodies();
    SpringDamper element{"spring", {first, second}, {{0.31, -0.17, 0}, {-0.23, 0.12, 0}}, 70, 9, 0.4, sine()};
    spring.spring_dampers.push_back(element);
    all.emplace_back("spring" + ends, spring);
    element.point[0] = element.point[1] = {0, 0, 0};
    spring.spring_dampers[0] = element;
    all.emplace_back("spring between centres" + ends, spring);
    Model torsion = two_bodies();
    torsion.torsional_spring_dampers.push_back({"torsion", {first, second}, 30, 4, 0.2});
    all.emplace_back("torsion" + ends, torsion);
  }
  for (const bool follows : {false, true}) {
    Model force = two_bodies();
    force.applied_forces.push_back({"push", 1, {0.2, -0.3, 0}, sine(), sine(), sine(), follows, {}, {}, {}});
    force.applied_forces[0].fy.value = -1.3;
    all.emplace_back(follows ? "following force" : "force", force);
  }
  all.emplace_back("coupler", coupled_bodies());
  return all;
}

// At a position that satisfies no constraint: the derivatives hold everywhere.
struct DistortedProbe : Probe {
  explicit DistortedProbe(const Model& sample) : Probe(sample) {
    position = {0.35, -0.25, 0.3, 1.2, 0.6, -0.7}, velocity = {0.4, -0.9, 1.3, -0.6, 0.8, -2.1};
  }
};

}  // namespace

TEST_CASE("stiffness and damping are the derivatives of the forces") {
  for (const auto& [name, model] : samples()) {
    INFO(name);
    DistortedProbe probe(model);
    const int n = probe.system.coordinates();
    probe.evaluate(probe.position, probe.velocity);
    const std::vector<Real> still(static_cast<std::size_t>(n), 0);
    const SystemInstant at{kTime, probe.position, probe.velocity};
    probe.system.differentiate(at, {still, still, probe.multipliers}, probe.derivatives);
    check_equal(dense(probe.derivatives.stiffness, n, n),
                differences([&](const auto& q) { return probe.force(q, probe.velocity); }, probe.position));
    check_equal(dense(probe.derivatives.damping, n, n),
                differences([&](const auto& v) { return probe.force(probe.position, v); }, probe.velocity));
  }
}

TEST_CASE("the constraint Jacobian and right-hand sides are the derivatives of the constraints") {
  for (const auto& [name, model] : samples()) {
    INFO(name);
    DistortedProbe probe(model);
    const auto constraint = [&](const std::vector<Real>& q, Real t) {
      probe.evaluate(q, probe.velocity, t);
      return probe.terms.constraint;
    };
    // Along q(t + s) = q + s q': Phi' = Phi_q q' - velocity_rhs, and Phi'' = -acceleration_rhs as q'' = 0.
    const auto along = [&](Real s) {
      std::vector<Real> q = probe.position;
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += s * probe.velocity[i];
      return constraint(q, kTime + s);
    };
    const Matrix numeric = differences([&](const auto& q) { return constraint(q, kTime); }, probe.position);
    constexpr Real kStep = 1e-4;  // truncation of some 1e-7, round-off of second differences is as large
    const std::vector<Real> before = along(-kStep), now = along(0), after = along(kStep);
    probe.evaluate(probe.position, probe.velocity);
    const SystemInstant at{kTime, probe.position, probe.velocity};
    const int rows = probe.system.constraints();
    check_equal(dense(probe.terms.constraint_jacobian, rows, probe.system.coordinates()), numeric);
    std::vector<Real> rate(now.size()), second(now.size());
    probe.system.velocity_rhs(at, rate);
    probe.system.acceleration_rhs(at, second);
    for (Real& r : rate) r = -r;
    probe.terms.constraint_jacobian.multiply(1, probe.velocity, rate);
    for (std::size_t j = 0; j < now.size(); ++j) {
      CHECK(near(rate[j], (after[j] - before[j]) / (2 * kStep), {.absolute = 1.2e-7}));
      CHECK(near(-second[j], (after[j] - 2 * now[j] + before[j]) / (kStep * kStep), {.absolute = 5e-7}));
    }
  }
}

namespace {

// Stiffness block of a body with a force proportional to the displacement of the point at `arm` along the
// normal.
std::array<Real, 21> block_along(Vec3 normal, Vec3 arm, Real slope) {
  const Vec3 moment = cross(arm, normal);
  const Real along[6] = {normal.x, normal.y, normal.z, moment.x, moment.y, moment.z};
  std::array<Real, 21> packed{};
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) packed[static_cast<std::size_t>(packed6(i, j))] = slope * along[i] * along[j];
  return packed;
}

}  // namespace

TEST_CASE("Newton's matrix is the derivative of the residual, contact included") {
  Model model = two_bodies();
  model.integrator.hht_alpha = -0.2;
  model.joints.push_back(joint_between(JointKind::translational, 0, 1));
  model.drivers.push_back({"driver", 0, sine()});
  model.spring_dampers.push_back({"spring", {kGround, 0}, {{2, 1, 0}, {-0.23, 0.12, 0}}, 70, 9, 0.4, sine()});
  DistortedProbe probe(model);
  HhtMethod method(probe.system, model.integrator.hht_alpha, probe.position, probe.velocity);
  MultibodyState state;
  state.position = probe.position;
  state.velocity = probe.velocity;
  state.acceleration = {1, -2, 3, -1, 2, 0.5};
  state.multipliers = probe.multipliers;
  state.force = {0.3, 0.1, -0.2, 0.5, -0.6, 0.1};
  const std::size_t n = state.position.size(), size = n + state.multipliers.size();
  constexpr Real kStep = 0.02;

  // A contact of body 1 with a plane: a linear spring and damper along n at an arm from its centre.
  ContactWrenches contacts{std::vector<BodyWrench>(2), {}};
  const Vec3 normal{0.6, 0.8, 0}, arm{0.03, -0.04, 0};
  const Sym3 stiffness = outer(300, normal), damping = outer(5, normal);
  const auto residual_at = [&](const std::vector<Real>& unknowns) {
    method.predict(state, 0.1, kStep);
    std::vector<Real> delta(size);
    for (std::size_t i = 0; i < size; ++i) {
      delta[i] = (i < n ? state.acceleration[i] : state.multipliers[i - n]) - unknowns[i];
    }
    method.apply_correction(delta);
    const std::vector<Real>&q = method.position(), &v = method.velocity();
    const Vec3 moved{q[3] - arm.y * q[5], q[4] + arm.x * q[5], 0},
        rate{v[3] - arm.y * v[5], v[4] + arm.x * v[5], 0};
    const Vec3 force = -(stiffness * moved) - damping * rate;
    contacts.wrench[1] = {force, cross(arm, force)};
    contacts.stiffness = {{1, block_along(normal, arm, 300), block_along(normal, arm, 5)}};
    probe.system.set_contacts(contacts);
    method.evaluate_residual();
    return method.residual();
  };
  std::vector<Real> unknowns = state.acceleration;
  unknowns.insert(unknowns.end(), state.multipliers.begin(), state.multipliers.end());
  for (Real& x : unknowns) x += 0.3;
  // The positions depend on an acceleration only times beta h^2, so its increments are large.
  const Matrix numeric = differences(residual_at, unknowns, 0.1);
  residual_at(unknowns);
  std::vector<Real> values(method.pattern().column.size());
  method.newton_matrix(values);
  Matrix analytic(size, std::vector<Real>(size, 0));
  for (std::size_t i = 0; i < size; ++i) {
    for (int k = method.pattern().row_start[i]; k < method.pattern().row_start[i + 1]; ++k) {
      analytic[i][static_cast<std::size_t>(method.pattern().column[static_cast<std::size_t>(k)])] =
          values[static_cast<std::size_t>(k)];
    }
  }
  check_equal(analytic, numeric);
}
