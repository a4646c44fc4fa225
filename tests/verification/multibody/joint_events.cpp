// Efforts on joints whose law changes within a step: a motor's limit, a joint that sticks, slides and sticks
// again. Of second order wherever in the step the change is, at any hht_alpha.
#include <array>
#include <cmath>
#include <string>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/multibody_run.hpp"

using namespace scree;

namespace {

constexpr Real kLeastOrder = 1.95, kMostOrder = 2.05;

TimeFunction sine(Real mean, Real amplitude, Real frequency) {
  TimeFunction function;
  function.kind = TimeFunction::Kind::sine;
  function.value = mean, function.amplitude = amplitude, function.frequency = frequency;
  return function;
}

// A disc of 0.005 kg m^2 on a pin, at or off its centre.
Model wheel(Real alpha, Real arm = 0) {
  Model model = empty_model();
  model.integrator.hht_alpha = alpha;
  model.time.end = 10;
  if (arm == 0) model.gravity = {};
  model.bodies = {paper_disc("wheel", arm, 0)};
  model.joints = {ground_pin("pin", 0, {}, {-arm, 0, 0})};
  return model;
}

void add_speed_motor(Model& model, const TimeFunction& rate, Real limit) {
  Motor motor;
  motor.name = "motor", motor.kind = MotorKind::speed, motor.limit = limit;
  motor.gain = 0.1, motor.integral_gain = 0.5, motor.rate = rate;
  model.motors = {motor};
}

// A disc of 1 kg on a slider along x, pulled back and forth.
Model block(Real alpha, Real static_ratio, Real damping, Real stiffness) {
  Model model = empty_model();
  model.integrator.hht_alpha = alpha;
  model.bodies = {paper_disc("block", 0, 0)};
  Joint slide;
  slide.name = "slide", slide.kind = JointKind::translational;
  slide.body[1] = 0;
  model.joints = {slide};
  JointFriction friction;
  friction.name = "friction", friction.effort = 1, friction.lever = 0.2, friction.stiffness = stiffness;
  friction.damping = damping, friction.static_ratio = static_ratio;
  if (static_ratio > 1) friction.stribeck_rate = 0.3;
  model.joint_frictions = {friction};
  AppliedForce pull;
  pull.name = "pull", pull.fx = sine(0, 6, 1.1);
  model.applied_forces = {pull};
  return model;
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

struct Outcome {
  Real position = 0, gap = 0;  // of the coordinate at the end; largest of the energy balance [J]
  int sticks = 0, most_iterations = 0;
};

Outcome outcome_of(const Model& model, int coordinate, Real h, Real end) {
  MultibodyRun run(model, 1e-11);
  Outcome out;
  const Real start = energy(run);
  bool slid = false;
  for (int i = 0; i < static_cast<int>(std::lround(end / h)); ++i) {
    run.step(h);
    out.gap = std::max(out.gap, std::abs(energy(run) - start));
    const bool slides = std::abs(run.state.velocity[static_cast<std::size_t>(coordinate)]) > 0.05;
    out.sticks += slid && !slides;
    slid = slides;
  }
  out.position = run.state.position[static_cast<std::size_t>(coordinate)];
  out.most_iterations = run.most_iterations;
  return out;
}

// The orders over three steps, each half of the one before; exact: value at the end.
void check_orders(const Model& model, int coordinate, Real coarse, Real end, Real exact) {
  std::array<Real, 3> error{};
  for (std::size_t i = 0; i < error.size(); ++i) {
    const Outcome out = outcome_of(model, coordinate, std::ldexp(coarse, -static_cast<int>(i)), end);
    error[i] = std::abs(out.position - exact);
    CHECK(out.most_iterations <= 8);
  }
  INFO("errors " << error[0] << ", " << error[1] << ", " << error[2]);
  for (std::size_t i = 1; i < error.size(); ++i)
    CHECK(in_range(std::log2(error[i - 1] / error[i]), kLeastOrder, kMostOrder));
}

}  // namespace

TEST_CASE("a motor that leaves its limit within a step rotates by the angle of the closed form") {
  // At the limit w = 10 t until e = 0.5; then, critically damped, e = (0.5 - 5 s) exp(-10 s) at the time s.
  const Real rate = 19.877, free = (rate - 0.5) / 10, s = 2.1 - free;
  const Real exact = 5 * free * free + rate * s - 0.5 * s * std::exp(-10 * s);
  for (const Real alpha : {0.0, -0.05, -0.3}) {
    INFO("alpha = " << alpha);
    Model model = wheel(alpha);
    TimeFunction wanted;
    wanted.value = rate;
    add_speed_motor(model, wanted, 0.05);
    check_orders(model, 2, 2e-3, 2.1, exact);
    CHECK(outcome_of(model, 2, 2e-3, 2.1).gap < 1e-12);
  }
}

TEST_CASE("a servo that leaves its limit within a step rotates by the angle of the closed form") {
  // At the limit w = 10 t until 0.05 (2 - 5 t^2) - 0.2 t = 0.05, at 0.2 s; then e = c - 2 follows
  // J e'' + D e' + P e = 0 from e = -1.8, e' = 2: J = 0.005, P = 0.05, D = 0.02.
  const Real end = 0.9137, s = end - 0.2, w = std::sqrt(6.0), b = (2 - 2 * 1.8) / w;
  const Real exact = 2 + std::exp(-2 * s) * (-1.8 * std::cos(w * s) + b * std::sin(w * s));
  Motor servo;
  servo.name = "servo", servo.kind = MotorKind::position, servo.limit = 0.05;
  servo.position.value = 2, servo.position_gain = 0.05, servo.rate_gain = 0.02;
  for (const Real alpha : {0.0, -0.05, -0.3}) {
    INFO("alpha = " << alpha);
    Model model = wheel(alpha);
    model.motors = {servo};
    check_orders(model, 2, end / 317, end, exact);
    CHECK(outcome_of(model, 2, end / 317, end).gap < 1e-12);
  }
}

TEST_CASE("a motor that reaches and leaves its limit repeatedly is of second order") {
  for (const Real alpha : {0.0, -0.05, -0.3}) {
    INFO("alpha = " << alpha);
    Model model = wheel(alpha);
    add_speed_motor(model, sine(5, 8, 0.7), 0.05);
    check_orders(model, 2, 2e-3, 3, outcome_of(model, 2, 2.5e-5, 3).position);
  }
  Model model = wheel(-0.05, 0.3);  // against a weight, which begins to fall as the motor reaches its limit
  add_speed_motor(model, sine(0, 4, 0.5), 3);
  check_orders(model, 2, 2e-3, 2, outcome_of(model, 2, 2.5e-5, 2).position);
}

TEST_CASE("friction with repeated changes between sticking and sliding is of second order") {
  struct Case {
    Real alpha, static_ratio, damping, stiffness;
  };
  for (const Case& c : {Case{0, 1, 0, 1e4}, Case{-0.05, 1, 20, 1e4}, Case{-0.3, 1, 20, 1e4},
                        Case{-0.05, 1.5, 20, 1e4}, Case{-0.3, 1.5, 20, 3e3}}) {
    INFO("alpha = " << c.alpha << ", ratio " << c.static_ratio << ", damping " << c.damping);
    const Model model = block(c.alpha, c.static_ratio, c.damping, c.stiffness);
    const Outcome exact = outcome_of(model, 0, 1e-5, 2);
    CHECK(exact.sticks >= 4);
    check_orders(model, 0, 1e-3, 2, exact.position);
  }
}
