// A slider-crank mechanism whose crank is driven: the motion is known in closed form.
#include <cmath>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"

using namespace scree;

namespace {

constexpr Real kCrank = 0.15, kRod = 0.4, kSpeed = 9, kStartAngle = 0.7;  // [m, m, rad/s, rad]
constexpr Real kCrankMass = 0.8, kRodMass = 1.1, kSliderMass = 0.6, kCrankInertia = 0.003,
               kRodInertia = 0.015;

// Angles of crank and rod and the slider's position with their first two derivatives, at a crank angle of
// constant rate: r sin(crank) + l sin(rod) = 0, x = r cos(crank) + l cos(rod).
struct Kinematics {
  explicit Kinematics(Real t) : crank(kStartAngle + kSpeed * t) {
    const Real ratio = kCrank / kRod, s = -ratio * std::sin(crank), c = std::sqrt(1 - s * s);
    rod = std::asin(s);
    rod_rate = -ratio * std::cos(crank) * kSpeed / c;
    rod_acceleration = (ratio * std::sin(crank) * kSpeed * kSpeed + s * rod_rate * rod_rate) / c;
    slider = kCrank * std::cos(crank) + kRod * c;
    slider_rate = -kCrank * std::sin(crank) * kSpeed - kRod * s * rod_rate;
    slider_acceleration = -kCrank * std::cos(crank) * kSpeed * kSpeed - kRod * c * rod_rate * rod_rate -
                          kRod * s * rod_acceleration;
  }
  Real crank, rod, rod_rate, rod_acceleration, slider, slider_rate, slider_acceleration;
};

// Torque of the driver from the power balance: torque kSpeed = d/dt (kinetic + gravitational energy).
Real driver_torque(Real t) {
  const Kinematics k(t);
  // The rod's centre, from the slider: (x - l/2 cos(rod), -l/2 sin(rod)).
  const Real s = std::sin(k.rod), c = std::cos(k.rod), half = kRod / 2;
  const Real vx = k.slider_rate + half * s * k.rod_rate, vy = -half * c * k.rod_rate;
  const Real ax = k.slider_acceleration + half * (s * k.rod_acceleration + c * k.rod_rate * k.rod_rate);
  const Real ay = half * (s * k.rod_rate * k.rod_rate - c * k.rod_acceleration);
  const Real crank_rise = kCrank / 2 * std::cos(k.crank) * kSpeed;
  const Real power = kSliderMass * k.slider_rate * k.slider_acceleration +
                     kRodMass * (vx * ax + vy * (ay + kGravity)) +
                     kRodInertia * k.rod_rate * k.rod_acceleration + kCrankMass * kGravity * crank_rise;
  return power / kSpeed;
}

Body link(const std::string& name, Real mass, Real inertia, Vec3 position, Vec3 velocity) {
  Body body;
  body.name = name;
  body.mass = mass;
  body.inertia = inertia;
  body.position = position;
  body.velocity = velocity;
  return body;
}

Model slider_crank() {
  const Kinematics k(0);
  const Real sc = std::sin(k.crank), cc = std::cos(k.crank), sr = std::sin(k.rod), cr = std::cos(k.rod);
  Model model = empty_model();
  model.integrator.hht_alpha = -0.1;
  Body crank = link("crank", kCrankMass, kCrankInertia, {kCrank / 2 * cc, kCrank / 2 * sc, 0},
                    {-kCrank / 2 * sc * kSpeed, kCrank / 2 * cc * kSpeed, 0});
  crank.angle = k.crank;
  crank.angular_velocity = kSpeed;
  Body rod = link("rod", kRodMass, kRodInertia, {k.slider - kRod / 2 * cr, -kRod / 2 * sr, 0},
                  {k.slider_rate + kRod / 2 * sr * k.rod_rate, -kRod / 2 * cr * k.rod_rate, 0});
  rod.angle = k.rod;
  rod.angular_velocity = k.rod_rate;
  model.bodies = {crank, rod, link("slider", kSliderMass, 0.001, {k.slider, 0, 0}, {k.slider_rate, 0, 0})};
  model.joints.push_back(ground_pin("shaft", 0, {0, 0, 0}, {-kCrank / 2, 0, 0}));
  model.joints.push_back(ground_pin("crank pin", 1, {kCrank / 2, 0, 0}, {-kRod / 2, 0, 0}));
  model.joints[1].body[0] = 0;
  model.joints.push_back(ground_pin("wrist", 2, {kRod / 2, 0, 0}, {0, 0, 0}));
  model.joints[2].body[0] = 1;
  model.joints.push_back(ground_pin("guide", 2, {0, 0, 0}, {0, 0, 0}));
  model.joints[3].kind = JointKind::translational;
  Driver motor;
  motor.name = "motor";
  motor.motion.kind = TimeFunction::Kind::ramp;
  motor.motion.value = kStartAngle;
  motor.motion.rate = kSpeed;
  model.drivers.push_back(motor);
  return model;
}

struct Errors {
  Real position = 0, velocity = 0, torque = 0;
};

Errors largest_errors(Real h) {
  MultibodyRun run(slider_crank());
  Errors errors;
  const int steps = static_cast<int>(std::lround(1 / h));
  for (int i = 1; i <= steps; ++i) {
    run.steps(1, h);
    run.time = i * h;
    const Kinematics exact(run.time);
    errors.position =
        std::max({errors.position, std::abs(run.x(2) - exact.slider), std::abs(run.angle(1) - exact.rod)});
    errors.velocity = std::max(errors.velocity, std::abs(run.state.velocity[6] - exact.slider_rate));
    const Real torque = run.multibody.reactions(run.state, run.time).back().torque.z;
    errors.torque = std::max(errors.torque, std::abs(torque - driver_torque(run.time)));
  }
  return errors;
}

}  // namespace

TEST_CASE("a driven slider-crank follows its kinematics, and its driver's torque balances the power") {
  const Errors coarse = largest_errors(1e-3), fine = largest_errors(5e-4);
  CAPTURE(coarse.position, coarse.velocity, fine.velocity, coarse.torque, fine.torque);
  CHECK(keeps(coarse.position, {.promise = 1e-10, .measured = 1e-15}));
  CHECK(keeps(fine.position, {.promise = 1e-10, .measured = 3e-15}));
  CHECK(keeps(fine.velocity, {.promise = 1e-4, .measured = 6.5e-6}));
  CHECK(std::log2(coarse.velocity / fine.velocity) > 1.95);
  CHECK(std::log2(coarse.velocity / fine.velocity) < 2.05);
  // The torque depends on the driver's motion alone, from the first step on.
  CHECK(keeps(coarse.torque, {.promise = 1e-10, .measured = 3e-13}));
}
