#include "run/state/step_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace scree {
namespace {

constexpr Real kSafety = 0.9, kMostGrowth = 2, kMostShrinkage = 0.1, kLeastShrinkage = 0.9;
// Two output times closer than this share of a step are one.
constexpr Real kSameTime = 1e-6;

}  // namespace

ClockState with_new_steps(const ClockState& state, const TimeControl& time) {
  ClockState next;
  next.time = next.start = next.end = state.time;  // a new segment begins
  next.next_step = time.step;
  next.histories = state.histories, next.snapshots = state.snapshots, next.checkpoints = state.checkpoints;
  return next;
}

StepClock::StepClock(const Model& model) : time_(model.time), output_(model.output) {
  // An end that equals an output time up to round-off becomes that time, so that a continued run has the same
  // times.
  for (const Real interval :
       {output_.checkpoint_interval, output_.snapshot_interval, output_.history_interval}) {
    const Real output_time = interval > 0 ? std::round(time_.end / interval) * interval : 0;
    if (std::abs(output_time - time_.end) <= same_time_margin()) time_.end = output_time;
  }
  state_.next_step = time_.step;
  open_segment();
}

StepClock::StepClock(const Model& model, const ClockState& state) : StepClock(model) {
  state_ = state;
  const auto recount = [&](std::int64_t& count, Real interval) {
    if (interval > 0)
      count = static_cast<std::int64_t>(std::floor((state_.time + same_time_margin()) / interval));
  };
  recount(state_.histories, output_.history_interval);
  recount(state_.snapshots, output_.snapshot_interval);
  recount(state_.checkpoints, output_.checkpoint_interval);
  // A state of a run with other intervals, at its end up to round-off: the remainder is too short for a step.
  if (std::abs(state_.time - time_.end) <= same_time_margin()) time_.end = state_.time;
  if (state_.time < state_.end && state_.end != next_output()) open_segment();
}

Real StepClock::same_time_margin() const {
  Real shortest = time_.step;
  for (const Real interval :
       {output_.checkpoint_interval, output_.snapshot_interval, output_.history_interval})
    if (interval > 0) shortest = std::min(shortest, interval);
  return kSameTime * shortest;
}

Real StepClock::next_output() const {
  Real next = time_.end;
  const Real margin = same_time_margin();
  const auto consider = [&](std::int64_t count, Real interval) {
    if (interval <= 0) return;
    const Real time = static_cast<Real>(count + 1) * interval;
    if (time < next - margin) next = time;
  };
  consider(state_.histories, output_.history_interval);
  consider(state_.snapshots, output_.snapshot_interval);
  consider(state_.checkpoints, output_.checkpoint_interval);
  return next;
}

void StepClock::open_segment() {
  state_.start = state_.time;
  state_.end = next_output();
  const Real steps = std::ceil((state_.end - state_.start) / time_.step - kSameTime);
  state_.grid_steps = std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
  state_.grid_done = state_.level = 0;
  state_.parts_left = 1;
}

std::int64_t steps_of_fixed(const Model& model) {
  constexpr std::int64_t kMostSegments = 1000000;
  StepClock clock(model);
  std::int64_t steps = 0;
  for (std::int64_t segments = 0; !clock.done() && segments < kMostSegments; ++segments) {
    steps += clock.state_.grid_steps;
    clock.state_.time = clock.state_.end;
    clock.take_history(), clock.take_snapshot(), clock.take_checkpoint();
    clock.open_segment();
  }
  return clock.done() ? steps : std::llround(static_cast<Real>(steps) * (clock.end() / clock.time()));
}

Real StepClock::begin_step() {
  if (state_.time == state_.end) open_segment();
  return step();
}

Real StepClock::step() const {
  if (time_.control == StepControl::fixed) {
    const Real exact = (state_.end - state_.start) / static_cast<Real>(state_.grid_steps);
    const Real grid_step = std::abs(exact - time_.step) <= kSameTime * time_.step ? time_.step : exact;
    return std::ldexp(grid_step, -static_cast<int>(state_.level));
  }
  const Real left = state_.end - state_.time;
  if (left <= state_.next_step * (1 + kSameTime)) return left;
  return left < 2 * state_.next_step ? left / 2 : state_.next_step;
}

std::vector<Real> StepClock::equal_steps(std::size_t most) const {
  std::vector<Real> times{state_.time};
  if (time_.control != StepControl::fixed || output_.history_interval <= 0) return times;
  StepClock ahead(*this);
  for (;;) {
    ahead.accepted(0);
    if (times.size() >= most || ahead.state_.time == state_.end || ahead.step() != step()) return times;
    times.push_back(ahead.time());
  }
}

Real StepClock::end_of(std::size_t equal_steps) const {
  StepClock ahead(*this);
  for (std::size_t k = 0; k < equal_steps; ++k) ahead.accepted(0);
  return ahead.time();
}

void StepClock::accepted(Real error) {
  const Real h = step();
  if (time_.control == StepControl::fixed) {
    if (--state_.parts_left == 0) ++state_.grid_done, state_.level = 0, state_.parts_left = 1;
    while (state_.level > 0 && state_.parts_left % 2 == 0) --state_.level, state_.parts_left /= 2;
    const Real part = 1 - std::ldexp(static_cast<Real>(state_.parts_left), -static_cast<int>(state_.level));
    const Real done = static_cast<Real>(state_.grid_done) + (part > 0 ? part : 0);
    state_.time = state_.start + (state_.end - state_.start) * (done / static_cast<Real>(state_.grid_steps));
    if (state_.grid_done == state_.grid_steps) state_.time = state_.end;
  } else {
    state_.time = h == state_.end - state_.time ? state_.end : state_.time + h;
    const Real wanted = error > 0 ? kSafety / std::cbrt(error) : kMostGrowth;
    const Real growth = std::clamp(wanted, kMostShrinkage, state_.just_rejected ? Real(1) : kMostGrowth);
    // A step shortened to reach an output time is no basis for the next step length.
    const Real base = h < state_.next_step && growth >= 1 ? state_.next_step : h;
    state_.next_step = std::clamp(base * growth, time_.min_step, time_.max_step);
    state_.just_rejected = false;
  }
}

void StepClock::shrink(Real factor, const std::string& reason) {
  const Real h = step();
  if (h * factor < time_.min_step)
    throw SimulationError(
        fmt::format("{}; the step at t = {:.9g} s, h = {:.3g} s, cannot be shortened below "
                    "time.min_step = {:g} s",
                    reason, state_.time, h, time_.min_step));
  state_.next_step = h * factor;
  state_.just_rejected = true;
}

void StepClock::rejected_for_error(Real error) {
  const Real factor = std::isfinite(error) ? kSafety / std::cbrt(error) : 0;
  shrink(std::clamp(factor, kMostShrinkage, kLeastShrinkage),
         fmt::format("stage accept: local error {:.3g} times the tolerance", error));
}

void StepClock::rejected_for_convergence(const std::string& reason) {
  shrink(0.5, reason);
  if (time_.control == StepControl::fixed) ++state_.level, state_.parts_left *= 2;
}

bool StepClock::reached(std::int64_t& count, Real interval) {
  if (interval <= 0 || state_.time != state_.end) return false;
  if (static_cast<Real>(count + 1) * interval > state_.time + same_time_margin()) return false;
  ++count;
  return true;
}

bool StepClock::take_history() {
  if (output_.history_interval <= 0) return true;
  return reached(state_.histories, output_.history_interval) || done();
}

bool StepClock::take_snapshot() { return reached(state_.snapshots, output_.snapshot_interval) || done(); }

bool StepClock::take_checkpoint() { return reached(state_.checkpoints, output_.checkpoint_interval); }

}  // namespace scree
