// The step interface: Newton's convergence, motion, error estimate, repeated steps; and the HHT core on a
// system of another kind.
#include <array>
#include <cmath>
#include <tuple>

#include "mbs/newton_solver.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

constexpr Real kRoundOff = 8 * kUlp;  // of a force on 1 kg, in three Newton iterations

// A free particle in polar coordinates (r, phi): the mass matrix diag(m, m r^2) depends on the position.
class PolarParticle final : public MechanicalSystem {
 public:
  int positions() const override { return 2; }
  int coordinates() const override { return 2; }
  int constraints() const override { return 0; }
  void evaluate(const SystemInstant& at, SystemTerms& terms) override {
    const Real r = at.position[0], rate = at.velocity[0], spin = at.velocity[1];
    terms.applied_force = {kMass * r * spin * spin, -2 * kMass * r * rate * spin};
    terms.force_scale = kMass;
    terms.mass.begin();
    terms.mass.add(0, 0, kMass);
    terms.mass.add(1, 1, kMass * r * r);
    terms.constraint_jacobian.begin();
  }
  void displace(const std::vector<Real>& start, const std::vector<Real>& displacement,
                std::vector<Real>& position) const override {
    for (std::size_t i = 0; i < 2; ++i) position[i] = start[i] + displacement[i];
  }
  void pull_back(const std::vector<Real>&, std::vector<Real>&) const override {}
  void differentiate(const SystemInstant& at, const SystemIterate& iterate,
                     SystemDerivatives& derivatives) override {
    const Real r = at.position[0], rate = at.velocity[0], spin = at.velocity[1];
    derivatives.stiffness.begin();
    derivatives.stiffness.add(0, 0, -kMass * spin * spin);
    derivatives.stiffness.add(1, 0, 2 * kMass * rate * spin);
    derivatives.damping.begin();
    derivatives.damping.add(0, 1, -2 * kMass * r * spin);
    derivatives.damping.add(1, 0, 2 * kMass * r * spin);
    derivatives.damping.add(1, 1, 2 * kMass * r * rate);
    derivatives.inertia_stiffness.begin();
    derivatives.inertia_stiffness.add(1, 0, 2 * kMass * r * iterate.acceleration[1]);
  }
  void velocity_rhs(const SystemInstant&, std::vector<Real>&) const override {}
  void acceleration_rhs(const SystemInstant&, std::vector<Real>&) const override {}
  const std::vector<Real>& coordinate_scale() const override { return scale_; }
  const std::vector<Real>& constraint_scale() const override { return no_scale_; }
  std::string coordinate_name(int) const override { return "particle"; }
  std::string constraint_name(int) const override { return ""; }

 private:
  static constexpr Real kMass = 2.5;
  std::vector<Real> scale_{1, 1}, no_scale_;
};

// Error after one second of a particle that moves along the straight line x = 1, y = 0.8 t. alpha = 0: see
// HhtMethod.
Real polar_error(Real h, int& most_iterations) {
  petsc();
  PolarParticle particle;
  MultibodyState state;
  state.position = {1, 0};
  state.velocity = {0, 0.8};
  HhtMethod method(particle, 0, state.position, state.velocity);
  NewtonSolver newton(particle, method);
  newton.solve_acceleration(state, 0);
  const int steps = static_cast<int>(std::lround(1 / h));
  for (int i = 0; i < steps; ++i) {
    method.predict(state, i * h, h);
    newton.begin_step();
    int iterations = 0;
    IterationNorms norms;
    do {
      norms = newton.iterate();
      most_iterations = std::max(most_iterations, ++iterations);
    } while ((norms.residual > 1e-11 || norms.correction > 1e-11) && iterations < 20);
    method.close(state);
  }
  const Real x = state.position[0] * std::cos(state.position[1]),
             y = state.position[0] * std::sin(state.position[1]);
  return std::hypot(x - 1, y - 0.8);
}

}  // namespace

TEST_CASE("the HHT core integrates a system whose mass depends on the position") {
  constexpr Real kTruncationOrder = 2e-4;  // of the observed order at these steps
  int most_iterations = 0;
  const Real coarse = polar_error(1e-2, most_iterations), fine = polar_error(5e-3, most_iterations);
  CAPTURE(coarse, fine);
  CHECK(near(std::log2(coarse / fine), 2, {.absolute = kTruncationOrder}));
  CHECK(most_iterations <= 4);
}

TEST_CASE("a linear system converges in two iterations") {
  Model model = empty_model();
  model.bodies = {paper_disc("one", 0, 0), paper_disc("two", 1, 0)};
  for (const int body : {0, 1}) {
    model.joints.push_back(ground_pin("guide." + std::to_string(body), body, {1.0 * body, 0, 0}, {0, 0, 0}));
    model.joints.back().kind = JointKind::translational;
  }
  model.spring_dampers.push_back({"spring", {0, 1}, {}, 1e4, 20, 0.9, {}});
  MultibodyRun run(model);
  run.steps(200, 1e-3);
  CHECK(run.most_iterations == 2);
}

TEST_CASE("residuals reach 1e-8 of the forces at small steps") {
  MultibodyRun net(paper_net(), 1e-8);
  net.steps(50, 1e-5);
  CHECK(net.most_iterations <= 3);
  // At rest and without gravity: the residual is round-off of the springs' lengths, or zero.
  for (const Real stiffness : {1e9, 0.0}) {
    Model model = paper_net();
    model.gravity = {0, 0, 0};
    for (SpringDamper& spring : model.spring_dampers) spring.stiffness = stiffness;
    MultibodyRun run(model, 1e-8);
    run.steps(50, 1e-5);
    CHECK(run.most_iterations <= 3);
    CHECK(std::abs(run.y(9) + 0.6) < 1e-12);
  }
}

TEST_CASE("a rejected step leaves no trace") {
  const Model model = paper_net();
  MultibodyRun plain(model), disturbed(model);
  std::vector<BodyWrench> push(20);
  push[3].force = {5, -7, 0};
  for (int i = 0; i < 20; ++i) {
    disturbed.multibody.predict(disturbed.state, disturbed.time, 4e-3);
    for (int k = 0; k < 3; ++k) disturbed.multibody.correct({push, {}});
    plain.steps(1, 1e-3);
    disturbed.steps(1, 1e-3);
  }
  CHECK(same_bits(plain.state.position, disturbed.state.position));
  CHECK(same_bits(plain.state.multipliers, disturbed.state.multipliers));
  // A system that starts from the state continues with the same bits.
  MultibodyRun restarted(model);
  restarted.state = plain.state;
  restarted.time = plain.time;
  plain.steps(20, 1e-3);
  restarted.steps(20, 1e-3);
  CHECK(same_bits(plain.state.position, restarted.state.position));
  CHECK(same_bits(plain.state.multipliers, restarted.state.multipliers));
  CHECK(same_bits(plain.state.integrator_loss, restarted.state.integrator_loss));
}

TEST_CASE("reports of a state depend on the state alone, and leave no trace in the steps") {
  Model model = empty_model();
  model.integrator.hht_alpha = -0.05;
  model.bodies = {paper_disc("arm", 0.5, 0), paper_disc("block", 0.8, 0)};
  Joint slide;
  slide.name = "slide", slide.kind = JointKind::translational;
  slide.body[0] = 0, slide.body[1] = 1, slide.point[0] = {0.3, 0, 0}, slide.axis = {1, 0, 0};
  model.joints = {ground_pin("pivot", 0, {0, 0, 0}, {-0.5, 0, 0}), slide};
  JointFriction friction;
  friction.name = "friction", friction.joint = 1, friction.lever = 0.4, friction.stiffness = 1e4;
  model.joint_frictions = {friction};
  const ContactWrenches push{{BodyWrench{}, BodyWrench{{0.5, -2, 0}, {0, 0, 0.1}}}, {}};
  MultibodyRun plain(model), queried(model);
  for (int i = 0; i < 20; ++i) {
    for (MultibodyRun* run : {&plain, &queried}) {
      run->multibody.predict(run->state, run->time, 1e-3);
      for (int k = 0; k < 6; ++k) run->multibody.correct(push);
      run->multibody.accept(run->state, push.wrench);
      run->time += 1e-3;
    }
    const std::vector<Reaction> reported = queried.multibody.reactions(queried.state, queried.time);
    const Real effort = queried.multibody.joint_efforts(queried.state, queried.time)[0].effort;
    if (i > 14)  // it slides
      CHECK(near(std::abs(effort), 0.4 * norm(reported[1].force), {.relative = 1e-12}));
    MultibodyRun fresh(model);  // as after a restart
    const std::vector<Reaction> again = fresh.multibody.reactions(queried.state, queried.time);
    for (std::size_t k = 0; k < reported.size(); ++k) {
      CHECK(same_bits(reported[k].force, again[k].force));
      CHECK(same_bits(reported[k].torque, again[k].torque));
    }
    CHECK(same_bits(effort, fresh.multibody.joint_efforts(queried.state, queried.time)[0].effort));
  }
  CHECK(same_bits(plain.state.position, queried.state.position));
  CHECK(same_bits(plain.state.multipliers, queried.state.multipliers));
  CHECK(same_bits(plain.state.memory, queried.state.memory));
}

// The rod is perpendicular to the guide, so that its row is redundant to the guide's.
TEST_CASE("in a singular position the reactions are those of the step") {
  Model model = empty_model();
  model.bodies = {paper_disc("block", 0.3, 0)};
  Joint guide = ground_pin("guide", 0, {0, 0, 0}, {0, 0, 0}), rod = guide;
  guide.kind = JointKind::translational, guide.axis = {1, 0, 0};
  rod.name = "rod", rod.kind = JointKind::distance, rod.point[0] = {0, 0.4, 0}, rod.distance = 0.5;
  model.joints = {guide, rod};
  MultibodyRun run(model);
  CHECK(!same_bits(run.multibody.at_instant(run.state, 0).multipliers, {0, 0, 0}));
  run.state.position[0] = 0, run.state.multipliers = {1, 2, 3};
  CHECK(same_bits(run.multibody.at_instant(run.state, 0).multipliers, {1, 2, 3}));
}

TEST_CASE("contacts that change at a step's end leave nothing behind for the next one's factors") {
  const auto pushed_step = [](MultibodyRun& run) {
    const ContactWrenches push{{BodyWrench{{5, -7, 0}, {0, 0, 0.1}}}, {}};
    run.multibody.predict(run.state, run.time, 1e-2);
    for (int k = 0; k < 5; ++k) run.multibody.correct(push);
    run.multibody.accept(run.state, std::vector{BodyWrench{{}, {0, 0, 0.05}}});
    run.time += 1e-2;
  };
  // The arm rotates and Phi_q with it; a pin at the centre leaves Phi_q constant.
  for (const Real arm : {0.5, 0.0}) {
    CAPTURE(arm);
    Model model = empty_model();
    model.bodies.push_back(paper_disc("bob", arm, 0));
    model.joints.push_back(ground_pin("pivot", 0, {0, 0, 0}, {-arm, 0, 0}));
    MultibodyRun run(model);
    for (int i = 0; i < 10; ++i) pushed_step(run);
    // A run that starts here has factored no other matrix.
    model.bodies[0].position = {run.x(0), run.y(0), 0}, model.bodies[0].angle = run.angle(0);
    MultibodyRun fresh(model);
    fresh.state = run.state, fresh.time = run.time;
    pushed_step(run), pushed_step(fresh);
    CHECK(same_bits(run.state.acceleration, fresh.state.acceleration));
    CHECK(same_bits(run.state.multipliers, fresh.state.multipliers));
    CHECK(run.state.acceleration[2] != 0);
  }
}

TEST_CASE("motion, extrapolation and the error estimate") {
  Model model = empty_model();
  model.bodies.push_back(paper_disc("stone", 1, 2));
  model.bodies[0].velocity = {3, 0, 0};
  model.bodies[0].angle = 0.1;
  model.bodies[0].angular_velocity = 4;
  model.bodies[0].position.z = 0.7;
  MultibodyRun run(model);
  const std::vector<BodyMotion> ahead = run.multibody.motion(run.state, 0.5);
  CHECK(ahead[0].position.x == 2.5);
  CHECK(ahead[0].position.y == 2 - kGravity / 8);
  CHECK(ahead[0].position.z == 0.7);
  CHECK(near(ahead[0].angle, 2.1, {.relative = kRoundOff}));
  CHECK(ahead[0].velocity.y == -kGravity / 2);
  run.multibody.predict(run.state, 0, 0.5);
  CHECK(run.multibody.motion()[0].position.y == ahead[0].position.y);
  // Under a force that grows within the step the estimate is the coefficient times h^2 (a_1 - a_0) / radius.
  std::vector<BodyWrench> wrench(1);
  wrench[0].force.x = 2;
  wrench[0].torque.z = 1e-4;
  run.multibody.correct({wrench, {}});
  CHECK(near(run.multibody.error(), hht_coefficients(0).error_constant * 0.25 * 2 / 0.05,
             {.relative = kRoundOff}));
  wrench[0].torque.z = 1;
  run.multibody.correct({wrench, {}});
  CHECK(
      near(run.multibody.error(), hht_coefficients(0).error_constant * 0.25 * 200, {.relative = kRoundOff}));
}

// Surfaces are posed by the open step's motion, and by the state's after a restart or a rejected step.
TEST_CASE("the motion of a state in space is that of the step that led there, bit for bit") {
  const Model model = double_spherical(-0.1);
  MultibodyRun run(model);
  std::size_t same = 0;
  constexpr std::size_t kSteps = 300;  // they include unit quaternions that a second normalization changes
  for (std::size_t i = 0; i < kSteps; ++i) {
    run.step(1e-3);
    const std::vector<BodyMotion>& last = run.multibody.motion();
    const std::vector<BodyMotion> again = run.multibody.motion(run.state);
    const auto numbers = [](const BodyMotion& m) {
      const auto& [x, v, q, w] = std::tie(m.position, m.velocity, m.orientation, m.spin);
      return std::array{x.x, x.y, x.z, v.x, v.y, v.z, q.w, q.x, q.y, q.z, w.x, w.y, w.z};
    };
    for (std::size_t b = 0; b < 2; ++b) same += same_bits(numbers(last[b]), numbers(again[b]));
  }
  CHECK(same == 2 * kSteps);
}

TEST_CASE("another wrench at the step's end changes accelerations and reactions, not the motion") {
  constexpr Real kAlpha = -0.1;
  Model model = empty_model();
  model.gravity = {0, 0, 0};
  model.integrator.hht_alpha = kAlpha;
  model.bodies = {paper_disc("free", 3, 0), paper_disc("bob", 0.5, 0)};
  model.joints.push_back(ground_pin("pivot", 1, {0, 0, 0}, {-0.5, 0, 0}));
  petsc();
  Multibody multibody(model);
  std::vector<BodyWrench> push(2);
  push[0].force = {3, 0, 0};
  push[1].force = {2, 0, 0};  // along the arm: the reaction of the pivot balances it
  MultibodyState state = multibody.initial_state(push);
  multibody.predict(state, 0, 1e-3);
  for (int i = 0; i < 3; ++i) multibody.correct({push, {}});
  const std::vector<BodyMotion> motion = multibody.motion();
  multibody.accept(state, std::vector<BodyWrench>(2));
  CHECK(state.position[0] == motion[0].position.x);
  CHECK(state.velocity[0] == motion[0].velocity.x);
  // q'' = (1 + alpha) H_{n+1} - alpha H_n over the mass, with H_{n+1} = 0.
  CHECK(near(state.acceleration[0], -kAlpha * 3, {.relative = kRoundOff}));
  CHECK(near(state.acceleration[3], 0, {.absolute = kRoundOff}));
  CHECK(state.applied[0] == 0);
  CHECK(near(multibody.reactions(state, 1e-3)[0].force.x, 0, {.absolute = kRoundOff}));
}
