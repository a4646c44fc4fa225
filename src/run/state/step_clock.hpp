// Time, step length and output times. Steps land exactly on output times; nothing compares rounded times.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "model/data/model.hpp"

namespace scree {

// All that the clock carries from step to step; part of the state.
struct ClockState {
  Real time = 0;                // t [s]
  Real start = 0, end = 0;      // of the segment between two output times [s]
  std::int64_t grid_steps = 0;  // fixed control: equal steps of this segment
  std::int64_t grid_done = 0;   // of them taken
  std::int64_t level = 0;       // fixed control: the grid step is being taken in 2^level parts
  std::int64_t parts_left = 1;  // of them to go
  Real next_step = 0;           // adaptive control: h wanted for the next step [s]
  bool just_rejected = false;   // adaptive control: no growth right after a rejection
  std::int64_t histories = 0, snapshots = 0, checkpoints = 0;  // output times reached
};

// How many fixed steps a run takes, where none has to be repeated: outputs cut some of them. Of more than a
// million outputs an estimate.
std::int64_t steps_of_fixed(const Model& model);

// At the same time, but with nothing carried on from the steps before: the next ones follow from these keys.
ClockState with_new_steps(const ClockState& state, const TimeControl& time);

class StepClock {
 public:
  explicit StepClock(const Model& model);
  // Goes on from a state, of a run whose output times and end may have been others.
  StepClock(const Model& model, const ClockState& state);

  const ClockState& state() const { return state_; }
  Real time() const { return state_.time; }
  // The deck's end, or the output time or the time gone on from that it is but for round-off [s].
  Real end() const { return time_.end; }
  bool done() const { return state_.time >= time_.end; }

  // Opens the next step, or the same one again after a rejection, and returns its length [s].
  Real begin_step();
  // Start times of the steps from the open one on that are as long as it, at most so many and none past the
  // next output [s].
  std::vector<Real> equal_steps(std::size_t most) const;
  // When the last of so many of them ends [s].
  Real end_of(std::size_t equal_steps) const;
  // The step was taken; error: local error over the tolerance.
  void accepted(Real error);
  // The step is to be repeated, shorter. Throws SimulationError, with the reason, when it would be shorter
  // than min_step.
  void rejected_for_error(Real error);
  void rejected_for_convergence(const std::string& reason);

  // Whether the time just reached is one for this output. Each is counted once.
  bool take_history();
  bool take_snapshot();
  bool take_checkpoint();

 private:
  Real step() const;
  void open_segment();
  Real next_output() const;
  Real same_time_margin() const;  // times closer than this are one [s]
  bool reached(std::int64_t& count, Real interval);
  void shrink(Real factor, const std::string& reason);
  friend std::int64_t steps_of_fixed(const Model& model);

  TimeControl time_;
  Output output_;
  ClockState state_;
};

}  // namespace scree
