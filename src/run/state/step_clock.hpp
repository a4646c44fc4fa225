// Time, step length and output times. Steps end exactly at output times; rounded times are never compared.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "model/data/model.hpp"

namespace scree {

// The data that the clock carries from step to step; part of the state.
struct ClockState {
  Real time = 0;                // t [s]
  Real start = 0, end = 0;      // of the segment between two output times [s]
  std::int64_t grid_steps = 0;  // fixed control: equal steps of this segment
  std::int64_t grid_done = 0;   // equal steps taken
  std::int64_t level = 0;       // fixed control: the equal step is taken in 2^level parts
  std::int64_t parts_left = 1;  // remaining parts
  Real next_step = 0;           // adaptive control: length of the next step [s]
  bool just_rejected = false;   // adaptive control: no growth right after a rejection
  std::int64_t histories = 0, snapshots = 0, checkpoints = 0;  // output times reached
};

// Number of fixed steps of a run without repeated steps; outputs shorten some of them. An estimate for more
// than a million outputs.
std::int64_t steps_of_fixed(const Model& model);

// The state at the same time without data from previous steps: the next step follows from these keys.
ClockState with_new_steps(const ClockState& state, const TimeControl& time);

class StepClock {
 public:
  explicit StepClock(const Model& model);
  // Continues from the state of a run that may have had other output times and another end.
  StepClock(const Model& model, const ClockState& state);

  const ClockState& state() const { return state_; }
  Real time() const { return state_.time; }
  // End of the run [s]: the deck's, or an output time or restart time that equals it up to round-off.
  Real end() const { return time_.end; }
  bool done() const { return state_.time >= time_.end; }

  // Opens the next step, or the same step again after a rejection, and returns its length [s].
  Real begin_step();
  // Start times [s] of the open step and of the following steps of equal length, at most `most` and none
  // after the next output.
  std::vector<Real> equal_steps(std::size_t most) const;
  // End of the last of so many equal steps [s].
  Real end_of(std::size_t equal_steps) const;
  // Accepts the step. error: local error over the tolerance.
  void accepted(Real error);
  // Rejects the step, which is to be repeated with a smaller length. Throws SimulationError with the reason
  // if that would be below min_step.
  void rejected_for_error(Real error);
  void rejected_for_convergence(const std::string& reason);

  // Whether the time just reached is an output time of this kind. Each output time counts once.
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
