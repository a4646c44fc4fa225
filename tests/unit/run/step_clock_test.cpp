// Steps land on output times, are bisected and rejoin their grid, grow and shrink within limits.
#include "run/state/step_clock.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "support/catch.hpp"
#include "support/decks.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;

Model timed_model(Real end, Real step, StepControl control = StepControl::fixed) {
  Model model;
  model.time.end = end, model.time.step = step, model.time.control = control;
  model.time.min_step = 1e-3 * step, model.time.max_step = 100 * step;
  return model;
}

struct IntervalCase {
  Real end, step, history, snapshot, checkpoint;
};

// Intervals that the step does not divide, that do not divide each other, and that are not representable.
const IntervalCase kIntervals[] = {{0.1, 7e-5, 1e-3, 0.1 / 3, 0}, {0.1, 1e-3, 0.1 / 3, 0.1 / 7, 0.05},
                                   {1, 1e-2, 0.1, 0.25, 0.3},     {0.3, 1e-4, 1e-3, 3e-3, 0.1},
                                   {0.05, 1, 0.01, 0.02, 0},      {1, 0.3, 0, 0, 0},
                                   {0.01, 1e-5, 1e-5, 1e-4, 0},   {1, 1.0 / 3, 1.0 / 3, 0, 0}};

// The error, relative to the tolerance, at which an adaptive step is kept: 0.9 / cbrt(error) = 1.
constexpr Real kSteady = 0.729;

// Times at which each output was due, and the lengths of all steps.
struct ClockRun {
  std::vector<Real> histories, snapshots, checkpoints, steps, times;

  explicit ClockRun(const Model& model) {
    StepClock clock(model);
    while (!clock.done()) {
      const Real before = clock.time(), h = clock.begin_step();
      clock.accepted(kSteady);
      steps.push_back(h), times.push_back(clock.time());
      REQUIRE(steps.size() < 20000);
      REQUIRE(near(clock.time(), before + h, {.relative = kRoundOff}));
      if (clock.take_history()) histories.push_back(clock.time());
      if (clock.take_snapshot()) snapshots.push_back(clock.time());
      if (clock.take_checkpoint()) checkpoints.push_back(clock.time());
    }
  }
};

// k * interval for k = 1, 2, ..., up to and, where asked, with the end.
std::vector<Real> multiples(Real interval, Real end, bool with_end) {
  std::vector<Real> times;
  for (int k = 1; interval > 0 && k * interval < end * (1 - 1e-9); ++k) times.push_back(k * interval);
  if (with_end) times.push_back(end);
  return times;
}

// Times of different outputs that coincide but for round-off are one time, the earlier one.
bool same_times(const std::vector<Real>& a, const std::vector<Real>& b) {
  const auto same = [](Real x, Real y) { return std::abs(x - y) <= 1e-15 * y; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

std::string failure(StepClock& clock, const std::string& reason) {
  try {
    for (int retry = 0; retry < 100; ++retry) clock.rejected_for_convergence(reason);
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("steps land on every output time in both controls") {
  for (const IntervalCase& c : kIntervals)
    for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
      CAPTURE(c.end, c.step, c.history, static_cast<int>(control));
      Model model = timed_model(c.end, c.step, control);
      model.time.max_step = 3 * c.step;
      model.output.history_interval = c.history, model.output.snapshot_interval = c.snapshot;
      model.output.checkpoint_interval = c.checkpoint;
      const ClockRun run(model);
      CHECK(run.times.back() == c.end);
      CHECK(same_times(run.histories, c.history > 0 ? multiples(c.history, c.end, true) : run.times));
      CHECK(same_times(run.snapshots, multiples(c.snapshot, c.end, true)));
      const bool checkpoint_at_end = c.checkpoint > 0 && std::abs(std::remainder(c.end, c.checkpoint)) < 1e-9;
      CHECK(same_times(run.checkpoints, multiples(c.checkpoint, c.end, checkpoint_at_end)));
    }
}

TEST_CASE("an output time is the same bits whatever the steps before it were") {
  for (const IntervalCase& c : kIntervals)
    for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
      if (c.history == 0) continue;
      CAPTURE(c.end, c.step, c.history, static_cast<int>(control));
      Model model = timed_model(c.end, c.step, control);
      model.time.max_step = 3 * c.step;
      model.output.history_interval = c.history;
      CHECK(ClockRun(model).histories == multiples(c.history, c.end, true));
    }
}

TEST_CASE("a fixed step is never longer than asked and as long as the output times allow") {
  for (const IntervalCase& c : kIntervals) {
    CAPTURE(c.end, c.step, c.history);
    Model model = timed_model(c.end, c.step);
    model.output.history_interval = c.history;
    const ClockRun run(model);
    for (const Real h : run.steps) CHECK(h <= c.step * (1 + 1e-6));
    // At most one step more per segment than the step's length requires.
    const Real segments = c.history > 0 ? static_cast<Real>(run.histories.size()) : 1;
    CHECK(static_cast<Real>(run.steps.size()) <= c.end / c.step + segments + 1e-9);
  }
}

TEST_CASE("fixed steps are counted beforehand as the clock takes them") {
  for (const IntervalCase& c : kIntervals) {
    Model model = timed_model(c.end, c.step);
    model.output.history_interval = c.history, model.output.snapshot_interval = c.snapshot;
    model.output.checkpoint_interval = c.checkpoint;
    StepClock clock(model);
    std::int64_t steps = 0;
    while (!clock.done()) {
      clock.begin_step(), clock.accepted(0), ++steps;
      clock.take_history(), clock.take_snapshot(), clock.take_checkpoint();
    }
    CAPTURE(c.end, c.step, c.history, c.snapshot);
    CHECK(steps_of_fixed(model) == steps);
  }
}

TEST_CASE("a step that divides the output interval is taken as it is written in the deck") {
  Model model = timed_model(1, 1e-4);
  model.output.history_interval = 1e-3;
  for (const Real h : ClockRun(model).steps) CHECK(h == 1e-4);
}

TEST_CASE("a fixed step that fails is taken in halves and the grid is met again") {
  const Model model = timed_model(1, 0.25);
  StepClock clock(model), plain(model);
  plain.begin_step(), plain.accepted(0);
  CHECK(clock.begin_step() == 0.25);
  clock.rejected_for_convergence("no");
  CHECK(clock.begin_step() == 0.125);
  clock.rejected_for_convergence("no");
  // A quarter; then the second quarter; then the remaining half in one step.
  std::vector<Real> lengths;
  while (clock.time() < 0.25) {
    lengths.push_back(clock.begin_step());
    clock.accepted(0);
  }
  CHECK(lengths == std::vector<Real>{0.0625, 0.0625, 0.125});
  CHECK(clock.time() == plain.time());
  CHECK(clock.begin_step() == 0.25);
}

TEST_CASE("whatever fails, fixed steps meet the grid to the bit") {
  Model model = timed_model(0.1, 7e-4);
  model.output.history_interval = 0.1 / 3;
  const ClockRun plain(model);
  StepClock clock(model);
  std::vector<Real> times;
  for (int k = 0; !clock.done(); ++k) {
    clock.begin_step();
    if (k % 3 == 0 || k % 7 == 5)
      clock.rejected_for_convergence("no");
    else
      clock.accepted(0);
    clock.take_history();
    times.push_back(clock.time());
  }
  for (const Real time : plain.times) CHECK(std::count(times.begin(), times.end(), time) > 0);
}

TEST_CASE("an adaptive step grows and shrinks within limits") {
  const Model model = timed_model(1e6, 1, StepControl::adaptive);
  StepClock clock(model);
  CHECK(clock.begin_step() == 1);
  clock.accepted(1e-30);  // negligible error: twice as long
  CHECK(clock.begin_step() == 2);
  clock.rejected_for_error(8);  // 0.9 / 2
  CHECK(near(clock.begin_step(), 0.9, {.relative = kRoundOff}));
  clock.accepted(1e-30);  // no growth right after a rejection
  CHECK(near(clock.begin_step(), 0.9, {.relative = kRoundOff}));
  clock.accepted(kSteady);
  CHECK(near(clock.begin_step(), 0.9, {.relative = kRoundOff}));
  clock.rejected_for_error(1.0001);  // at least a tenth shorter
  CHECK(near(clock.begin_step(), 0.81 / std::cbrt(1.0001), {.relative = kRoundOff}));
  clock.rejected_for_error(1e30);  // at most ten times shorter
  CHECK(near(clock.begin_step(), 0.081 / std::cbrt(1.0001), {.relative = kRoundOff}));
  clock.rejected_for_convergence("no");
  CHECK(near(clock.begin_step(), 0.0405 / std::cbrt(1.0001), {.relative = kRoundOff}));
  for (int k = 0; k < 40; ++k) clock.begin_step(), clock.accepted(0);
  CHECK(clock.begin_step() == model.time.max_step);
}

TEST_CASE("a step cut short to land on an output time does not make the next one short") {
  Model model = timed_model(10, 1, StepControl::adaptive);
  model.output.history_interval = 2.1;
  const ClockRun run(model);
  CHECK(run.steps.size() <= 16);
  CHECK(*std::min_element(run.steps.begin(), run.steps.end()) >
        0.3);  // the last stretch is halved, not cut into tiny steps
}

TEST_CASE("a step that cannot be shortened fails with the reason, the time and the key") {
  for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
    const Model model = timed_model(1, 0.25, control);
    StepClock clock(model);
    clock.begin_step();
    const std::string message = failure(clock, "stage particle_correct: no convergence in 50 iterations");
    CHECK(contains(message, "stage particle_correct: no convergence in 50 iterations"));
    CHECK(contains(message, "t = 0 s"));
    CHECK(contains(message, "time.min_step = 0.00025 s"));
    // The last length tried was not shorter.
    CHECK(clock.begin_step() >= model.time.min_step);
    CHECK(clock.begin_step() < 2 * model.time.min_step);
  }
}

TEST_CASE("an error that is not a number shortens the step like the largest error") {
  StepClock clock(timed_model(1e6, 1, StepControl::adaptive));
  clock.begin_step();
  clock.rejected_for_error(std::nan(""));
  CHECK(near(clock.begin_step(), 0.1, {.relative = kRoundOff}));
}

TEST_CASE("a clock made from a state continues from there") {
  for (const StepControl control : {StepControl::fixed, StepControl::adaptive}) {
    Model model = timed_model(1, 0.01, control);
    model.output.history_interval = 0.1 / 3;
    StepClock clock(model);
    for (int k = 0; k < 7; ++k)
      clock.begin_step(), clock.accepted(0.5), clock.take_history(), clock.take_snapshot();
    clock.begin_step(), clock.rejected_for_convergence("no");
    StepClock copy(model, clock.state());
    while (!clock.done()) {
      REQUIRE(clock.begin_step() == copy.begin_step());
      clock.accepted(0.5), copy.accepted(0.5);
      REQUIRE(clock.time() == copy.time());
      CHECK(clock.take_history() == copy.take_history());
    }
    CHECK(copy.done());
  }
}

}  // namespace scree
