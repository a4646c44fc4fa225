// Servos: motors of type position against closed forms.
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"

using namespace scree;

namespace {

constexpr Real kGain = 40, kRateGain = 3;  // of a body of 1 kg: a damping ratio of 0.24

Motor servo(Real gain, Real rate_gain) {
  Motor motor;
  motor.name = "servo", motor.kind = MotorKind::position;
  motor.position_gain = gain, motor.rate_gain = rate_gain;
  return motor;
}

// A disc of 1 kg that slides along x.
Model slider(Real alpha) {
  Model model = empty_model();
  model.gravity = {};
  model.integrator.hht_alpha = alpha;
  model.time.end = 10;
  model.bodies = {paper_disc("slider", 0, 0)};
  Joint slide;
  slide.name = "slide", slide.kind = JointKind::translational;
  slide.body[1] = 0;
  model.joints = {slide};
  return model;
}

// A disc of 0.005 kg m^2 on a pin at its centre.
Model wheel() {
  Model model = slider(-0.05);
  model.joints = {ground_pin("pin", 0, {}, {})};
  return model;
}

void push(Model& model, Real force) {
  AppliedForce load;
  load.name = "load", load.fx.value = force;
  model.applied_forces = {load};
}

Real energy(const MultibodyRun& run) {
  const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
  return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
         run.state.driver_work;
}

// m x'' + D x' + P x = P r + D r' + F with r = r_0 + a sin(2 pi f t), from rest at 0.
struct Response {
  Real r_0, a, frequency, force;

  Real at(Real t) const {
    using Complex = std::complex<Real>;
    const Complex i{0, 1};
    const Real w = 2 * std::numbers::pi_v<Real> * frequency, mean = r_0 + force / kGain;
    const Complex driven = a * (kGain + i * w * kRateGain) / (kGain - w * w + i * w * kRateGain);
    const auto steady = [&](Real s) { return mean + std::imag(driven * std::exp(i * w * s)); };
    const Real decay = kRateGain / 2, turn = std::sqrt(kGain - decay * decay),
               rate = std::imag(driven * i * w), x = -steady(0), v = -rate;
    return steady(t) +
           std::exp(-decay * t) * (x * std::cos(turn * t) + (v + decay * x) / turn * std::sin(turn * t));
  }
};

Real largest_error(const Model& model, const Response& exact, Real h, Real end) {
  MultibodyRun run(model, 1e-12);
  Real worst = 0;
  for (int k = 0; k < static_cast<int>(std::lround(end / h)); ++k) {
    run.step(h);
    worst = std::max(worst, std::abs(run.x(0) - exact.at(run.time)));
  }
  return worst;
}

}  // namespace

TEST_CASE("a servo responds as mass, spring and damper do, to second order") {
  for (const Response& exact : {Response{0.5, 0, 0, 2}, Response{0.1, 0.3, 1.3, -4}}) {
    for (const Real alpha : {0.0, -0.05}) {
      INFO("alpha = " << alpha << ", amplitude = " << exact.a);
      Model model = slider(alpha);
      Motor motor = servo(kGain, kRateGain);
      motor.position.kind = TimeFunction::Kind::sine;
      motor.position.value = exact.r_0, motor.position.amplitude = exact.a;
      motor.position.frequency = exact.frequency;
      model.motors = {motor};
      push(model, exact.force);
      std::array<Real, 3> error{};
      for (std::size_t i = 0; i < error.size(); ++i)
        error[i] = largest_error(model, exact, std::ldexp(Real(2e-3), -static_cast<int>(i)), 2);
      INFO("errors " << error[0] << ", " << error[1] << ", " << error[2]);
      for (std::size_t i = 1; i < error.size(); ++i)
        CHECK(in_range(std::log2(error[i - 1] / error[i]), 1.95, 2.05));
      CHECK(error[2] < 1e-5);
    }
  }
}

TEST_CASE("a load deflects a servo by load over gain, and beyond its limit it yields") {
  Model model = slider(-0.05);
  Motor motor = servo(200, 30);
  motor.position.value = 0.4;
  model.motors = {motor};
  model.gravity = {-3, 0, 0};  // a load of 3 N
  MultibodyRun run(model, 1e-12);
  const Real start = energy(run);
  run.steps(400, 1e-2);
  CHECK(near(run.x(0), 0.4 - 3.0 / 200, {.relative = 1e-9}));
  const JointEffortSample held = run.multibody.joint_efforts(run.state, run.time).at(0);
  CHECK(near(held.effort, 3, {.relative = 1e-8}));
  CHECK(near(energy(run), start, {.absolute = 1e-11}));
  // With less than the load it yields by the difference.
  model.motors[0].limit = 2;
  model.bodies[0].position.x = 0.4;
  MultibodyRun weak(model, 1e-12);
  weak.steps(400, 5e-3);
  CHECK(near(weak.multibody.joint_efforts(weak.state, weak.time).at(0).effort, 2, {.relative = 1e-12}));
  CHECK(weak.x(0) < 0.4 - 0.9 * (3 - 2) / 2.0 * 4);
}

TEST_CASE("a servo follows its position at any gains, steps far longer than its oscillations") {
  for (const Real gain : {1e-2, 1.0, 1e2, 1e6, 1e12})
    for (const Real rate_gain : {0.0, 1e-3, 1.0, 1e4}) {
      CAPTURE(gain, rate_gain);
      Model model = wheel();
      Motor motor = servo(gain, rate_gain);
      motor.position.kind = TimeFunction::Kind::step;
      motor.position.end_value = 0.3, motor.position.end = 1;
      model.motors = {motor};
      MultibodyRun run(model);
      run.steps(100, 1e-2);
      if (gain >= 1) CHECK(near(run.angle(0), 0.3, {.absolute = 0.1}));
      if (gain >= 1e6) CHECK(near(run.angle(0), 0.3, {.absolute = 1e-4}));
      for (int k = 0; k < 100; ++k) {
        run.step(1e-2);
        REQUIRE(std::abs(run.angle(0)) <= 0.61);
      }
      CHECK(run.most_iterations <= 4);
    }
}

TEST_CASE("a servo at its limit stays bounded at any gains, and Newton's method converges") {
  for (const Real gain : {1e-2, 1.0, 1e2, 1e4, 1e6, 1e9})
    for (const Real rate_gain : {0.0, 1e-3, 1.0, 1e2, 1e4, 1e7})
      for (const Real limit : {0.01, 0.5, 5.0}) {
        CAPTURE(gain, rate_gain, limit);
        Model model = wheel();
        Motor motor = servo(gain, rate_gain);
        motor.position.value = 0.3, motor.limit = limit;
        model.motors = {motor};
        MultibodyRun run(model, 1e-8);  // the deck's default
        for (int k = 0; k < 100; ++k) {
          run.step(1e-2);
          REQUIRE(std::abs(run.angle(0)) <= 0.61);
        }
        CHECK(run.most_iterations <= 10);
        CHECK(std::isfinite(energy(run)));
      }
}
