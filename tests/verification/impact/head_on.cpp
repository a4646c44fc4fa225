// Head-on impact at 6.7 m/s with case 5.2's contact law, over all phases of the impact within a step.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/impacts.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kSpeed = 6.7;                                                 // [m/s]
const ClosedImpact kExact{10 / (2 * std::sqrt(1e7)), std::sqrt(1e7), true};  // K = 1e7, C = 10, m* = 1

const std::string kPinnedDisc = R"(
[[bodies]]
name = "disc"
position = [0.0, 0.0]
mass = 1.0
inertia = 0.005
shapes = [{ radius = 0.05 }]
[[joints]]
name = "pin"
type = "revolute"
bodies = ["ground", "disc"]
)";

enum class Obstacle { wall, pinned_disc };

// The particle starts `gap` [m] above the obstacle and falls on it.
Model head_on(Obstacle obstacle, Real gap) {
  const std::string deck = impact_deck(1e7, 10, true), far = "particles.disc.positions=[[0.0, 0.5]]";
  Model model = model_of(obstacle == Obstacle::wall ? deck : deck + kPinnedDisc, {far});
  model.particles.position[0] = {0, obstacle == Obstacle::wall ? -0.95 + gap : 0.1 + gap, 0};
  model.particles.velocity[0] = {0, -kSpeed, 0};
  return model;
}

// Relative errors of the rebound's speed.
struct ReboundError {
  Real rms = 0, largest = 0;
};

// The impact at `phases` equally spaced instants within a step of length h [s], the step of the model's
// control.
template <class Change>
ReboundError rebound_error(Obstacle obstacle, Real h, int phases, const Change& change) {
  ReboundError error;
  for (int phase = 0; phase < phases; ++phase) {
    Model model = head_on(obstacle, kSpeed * h * (1.5 + (phase + 0.5) / phases));
    model.time.step = h;
    model.time.max_step = h;
    // Whole steps: less than three to the touch, then the contact, and its extension by a coarse step.
    model.time.end = h * std::ceil(kExact.duration() / h + 6);
    change(model);
    SimulationRun run(model);
    run.run();
    const Real speed = run.particles()[0].velocity.y;
    const Real relative = std::abs(speed / (kExact.restitution() * kSpeed) - 1);
    error.rms += relative * relative / phases;
    error.largest = std::max(error.largest, relative);
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

ReboundError fixed_step_error(Real h, int phases, Real hht_alpha, bool resolve_events) {
  return rebound_error(Obstacle::wall, h, phases, [&](Model& model) {
    model.integrator.hht_alpha = hht_alpha;
    model.integrator.resolve_events = resolve_events;
  });
}

void report(const std::string& what, const ReboundError& error) {
  std::cout << fmt::format("{}: rebound error rms {:.3g} %, largest {:.3g} %\n", what, 100 * error.rms,
                           100 * error.largest);
}

}  // namespace

TEST_CASE("the exact rebound of case 5.2's impact") {  // to half of the last digit given
  CHECK(near(kExact.restitution() * kSpeed, 6.6668, {.absolute = 5e-5}));
  CHECK(near(kExact.duration(), 0.993e-3, {.absolute = 5e-7}));
}

TEST_CASE("a resolved fixed step keeps the rebound") {
  constexpr Real kPhysical = 3e-4;  // the promise for h = 1e-5
  for (const Obstacle obstacle : {Obstacle::wall, Obstacle::pinned_disc}) {
    const ReboundError error = rebound_error(obstacle, 1e-5, 50, [](Model&) {});
    report(obstacle == Obstacle::wall ? "wall, h = 1e-5" : "pinned disc, h = 1e-5", error);
    CHECK(measured("head_on/fixed", "", keeps(error.largest, {.promise = kPhysical, .measured = 8.4e-6})));
  }
}

TEST_CASE("the adaptive step at its default tolerance keeps the rebound") {
  constexpr Real kPhysical = 5e-3;  // the promise
  for (const Obstacle obstacle : {Obstacle::wall, Obstacle::pinned_disc}) {
    const ReboundError error = rebound_error(obstacle, 1e-4, 50, [](Model& model) {
      model.time.control = StepControl::adaptive;
      model.time.max_step = 1e-2;
    });
    report(obstacle == Obstacle::wall ? "wall, adaptive" : "pinned disc, adaptive", error);
    CHECK(measured("head_on/adaptive", "", keeps(error.largest, {.promise = kPhysical, .measured = 2.5e-6})));
  }
}

// The table of tests/reference/README.md, whose rms errors have one or two digits.
TEST_CASE("with the force at the end of the step the rebound errs as the paper's method does") {
  constexpr Real kTableDigits = 1;  // relative to the last digit given: rounding, and another set of phases
  struct Column {
    Real h;
    std::array<Real, 2> error, digit;  // at alpha = 0 and -0.3; and the value of their last digit
  };
  const std::array<Column, 6> table = {{{1e-3, {0.43, 0.28}, {0.01, 0.01}},
                                        {5e-4, {0.13, 0.12}, {0.01, 0.01}},
                                        {2e-4, {0.013, 0.019}, {0.001, 0.001}},
                                        {1e-4, {0.0005, 0.002}, {0.0001, 0.001}},
                                        {5e-5, {0.0006, 0.0005}, {0.0001, 0.0001}},
                                        {1e-5, {0.00008, 0.00008}, {0.00001, 0.00001}}}};
  for (const Column& column : table) {
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const ReboundError error = fixed_step_error(column.h, 400, k == 0 ? 0 : -0.3, false);
      report(fmt::format("end of step, h = {:g}, alpha = {}", column.h, k == 0 ? 0 : -0.3), error);
      CAPTURE(column.h, k, error.rms);
      CHECK(std::abs(error.rms - column.error[k]) <= kTableDigits * column.digit[k]);
    }
  }
}

TEST_CASE("resolved contact events keep the rebound at any step") {
  constexpr Real kPhysical = 2.5e-3;  // a little more than energy-momentum contact at h = 1e-3
  const ReboundError error = fixed_step_error(1e-3, 400, 0, true);
  report("resolved, h = 1e-3", error);
  CHECK(error.largest < kPhysical);
}

TEST_CASE("resolved contact events converge with second order") {
  constexpr Real kTruncationOrder = 0.1;
  const Real coarse = fixed_step_error(5e-5, 50, 0, true).rms,
             fine = fixed_step_error(1.25e-5, 50, 0, true).rms;
  const Real order = std::log2(coarse / fine) / 2;
  std::cout << fmt::format("resolved, alpha = 0: rebound error {:.2e} % at h = 5e-5, order {:.3f}\n",
                           100 * coarse, order);
  CAPTURE(coarse, fine);
  CHECK(keeps(order - 2, {.promise = kTruncationOrder, .measured = 0.019}));
}

// HHT weights the force at the start of a step by -alpha; with events within the steps the weights of
// consecutive steps no longer add up to one, which leaves a small error of first order in C.
TEST_CASE("resolved contact events with numerical damping stay below the errors of the paper's method") {
  const Real coarse = fixed_step_error(1e-4, 50, -0.3, true).rms,
             fine = fixed_step_error(1e-5, 50, -0.3, true).rms;
  CHECK(coarse < fixed_step_error(1e-4, 50, -0.3, false).rms);
  CHECK(fine < fixed_step_error(1e-5, 50, -0.3, false).rms);
}
