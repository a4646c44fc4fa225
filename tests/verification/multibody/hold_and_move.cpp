// A slider-crank whose driver holds, rotates the crank and holds again: the motion is known in closed form.
#include <array>
#include <cmath>

#include "physics/energy.hpp"
#include "physics/time_function.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"

using namespace scree;

namespace {

constexpr Real kCrank = 0.15, kRod = 0.4, kStart = 0.5, kEnd = 0.8, kTurn = 1.5;  // [m, m, s, s, rad]

Body link(const std::string& name, Real mass, Real inertia, Real x) {
  Body body;
  body.name = name;
  body.mass = mass;
  body.inertia = inertia;
  body.position = {x, 0, 0};
  return body;
}

// All bodies lie along the x axis at the start, crank angle 0.
Model slider_crank(const TimeFunction& motion, Real hht_alpha) {
  Model model = empty_model();
  model.time.end = 1.5;
  model.integrator.hht_alpha = hht_alpha;
  model.consistent_velocities = true;
  model.bodies = {link("crank", 0.8, 0.003, kCrank / 2), link("rod", 1.1, 0.015, kCrank + kRod / 2),
                  link("slider", 0.6, 0.001, kCrank + kRod)};
  model.joints.push_back(ground_pin("shaft", 0, {0, 0, 0}, {-kCrank / 2, 0, 0}));
  model.joints.push_back(ground_pin("crank pin", 1, {kCrank / 2, 0, 0}, {-kRod / 2, 0, 0}));
  model.joints[1].body[0] = 0;
  model.joints.push_back(ground_pin("wrist", 2, {kRod / 2, 0, 0}, {0, 0, 0}));
  model.joints[2].body[0] = 1;
  model.joints.push_back(ground_pin("guide", 2, {0, 0, 0}, {0, 0, 0}));
  model.joints[3].kind = JointKind::translational;
  model.drivers.push_back({"motor", 0, motion});
  return model;
}

TimeFunction step() {
  TimeFunction function;
  function.kind = TimeFunction::Kind::step;
  function.end_value = kTurn;
  function.start = kStart;
  function.end = kEnd;
  return function;
}

TimeFunction table(Interpolation interpolation) {
  TimeFunction function;
  function.kind = TimeFunction::Kind::table;
  function.times = {0, kStart, kEnd, 1.5};
  function.values = {0, 0, kTurn, kTurn};
  function.interpolation = interpolation;
  return function;
}

struct Slider {
  explicit Slider(const TimeValue& crank) {
    const Real ratio = kCrank / kRod, s = -ratio * std::sin(crank.value), c = std::sqrt(1 - s * s);
    place = kCrank * std::cos(crank.value) + kRod * c;
    rate = (-kCrank * std::sin(crank.value) - kRod * s * (-ratio * std::cos(crank.value)) / c) * crank.rate;
  }
  Real place, rate;
};

struct Outcome {
  Real place = 0, rate = 0;    // largest errors of the slider [m], [m/s]
  Real before = 0, after = 0;  // largest speed of any body while the driver holds [m/s], [rad/s]
  Real work = 0, gained = 0;   // of the driver; mechanical energy at the end less that at the start [J]
};

Outcome turn(const TimeFunction& motion, Real hht_alpha, Real h) {
  MultibodyRun run(slider_crank(motion, hht_alpha));
  Outcome out;
  const auto energy = [&] {
    const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
    return e.kinetic + e.gravitational;
  };
  const Real start = energy();
  const int steps = static_cast<int>(std::lround(1.5 / h));
  for (int i = 1; i <= steps; ++i) {
    run.steps(1, h);
    run.time = i * h;
    const Slider exact(step_function(0, kTurn, kStart, kEnd, run.time));
    out.place = std::max(out.place, std::abs(run.x(2) - exact.place));
    out.rate = std::max(out.rate, std::abs(run.state.velocity[6] - exact.rate));
    for (const Real v : run.state.velocity) {
      if (run.time <= kStart) out.before = std::max(out.before, std::abs(v));
      if (run.time >= kEnd + 0.1) out.after = std::max(out.after, std::abs(v));
    }
  }
  out.work = run.state.driver_work;
  out.gained = energy() - start;
  return out;
}

}  // namespace

TEST_CASE("a crank that holds and then moves follows its driver, and the driver's work is what it costs") {
  for (const TimeFunction& motion : {step(), table(Interpolation::monotone)}) {
    const Outcome coarse = turn(motion, -0.05, 1e-3), fine = turn(motion, -0.05, 5e-4);
    CAPTURE(coarse.rate, fine.rate, fine.before, fine.after, fine.work, fine.gained);
    CHECK(keeps(fine.place, {.promise = 1e-10, .measured = 2e-15}));
    CHECK(keeps(fine.rate, {.promise = 1e-3, .measured = 1.1e-5}));
    CHECK(std::log2(coarse.rate / fine.rate) > 1.8);  // class C2: the method keeps its second order
    CHECK(keeps(fine.before, {.promise = 1e-9, .measured = 2.1e-11}));
    CHECK(keeps(fine.after, {.promise = 1e-4, .measured = 1.5e-11}));
    CHECK(fine.gained > 0.5);
    CHECK(keeps(fine.work / fine.gained - 1, {.promise = 1e-3, .measured = 4.6e-8}));
  }
}

TEST_CASE("the same table on the natural spline begins with a backward rotation of the crank") {
  petsc();
  const Model model = slider_crank(table(Interpolation::natural), -0.05);
  const Multibody multibody(model);
  CHECK(multibody.start_change().find("body 'crank' (id 0) from 0.0 to -1.8") != std::string::npos);
  Model held = slider_crank(table(Interpolation::monotone), -0.05);
  CHECK(Multibody(held).start_change().empty());
}
