// The loop over steps; the functions read in the order of the algorithm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "base/log.hpp"
#include "coupling/coupled_step.hpp"
#include "run/population/births.hpp"
#include "run/record/timeline.hpp"
#include "run/state/records.hpp"
#include "run/state/state.hpp"
#include "run/state/step_clock.hpp"

namespace scree {

// stop_condition: one of the deck's is met, possibly at the end.
enum class LoopEnd { done, stop_condition, paused, stopped_by_signal };

// Time of a monotonic clock [s].
double steady_seconds();

// The objects that the loop uses; all of them must outlive it.
struct LoopParts {
  const Model& model;
  Backend& backend;
  BodyCoupling& link;
  CoupledStep& step;
  Records& records;
  StageTimers& timers;
  std::function<double()> seconds = steady_seconds;  // a monotonic clock [s]
  // Called with the particles that leave the domain, after the step in which they do.
  std::function<void(const std::vector<EscapedParticle>&)> leaving = [](const std::vector<EscapedParticle>&) {
  };
  Timeline* timeline = nullptr;      // of some steps, or none
  const Births* births = nullptr;    // of a model with inserters
  const Outlets* outlets = nullptr;  // of a model with outlets
};

// Number of explicit steps of the bodies in one batch. step_seconds: wall time per step of the last batch;
// mixed: whether the backend computes in mixed precision.
std::size_t batch_length(const Model& model, bool mixed, double step_seconds);

class StepLoop {
 public:
  // write_checkpoint: called with the complete state whenever a checkpoint is due; may move the particles
  // out.
  StepLoop(const LoopParts& parts, State& state, std::function<void(State&)> write_checkpoint,
           std::function<void(const State&, Real h)> progress);

  // Takes steps until the end, a stop condition or a signal, or pauses after the first step that reaches the
  // time `until` [s]; may then be called again. Throws SimulationError if the run cannot continue.
  LoopEnd run(Real until = kInfinity);
  int signal() const { return signal_; }  // the one that stopped the run, on any rank
  // The current state, complete with the particles.
  State& complete_state();
  // The state to save after a failure. Implicit: the start of the failed step. Explicit: a copy made some
  // steps ago, because explicit steps cannot be undone.
  State& last_saved_state();

 private:
  int poll_requests();
  void write_checkpoint();
  void take_recorded_step(Real until);
  void take_step(Real until);
  void reject(const StepOutcome& outcome);
  void take_explicit_steps(Real h, Real until);
  void close_step(Real h);
  bool leave();
  bool insert();
  Real next_change() const;
  void output(Real h);
  void save_good_state();
  const Ranks& ranks() const { return parts_.link.ranks(); }

  LoopParts parts_;
  State& state_;
  StepClock clock_;
  std::function<void(State&)> write_checkpoint_;
  std::function<void(const State&, Real)> progress_;
  bool implicit_;
  double step_seconds_ = std::numeric_limits<double>::infinity();  // per step, in the last batch
  std::int64_t next_sample_ = 0;  // number of steps at the next energy sample
  int signal_ = 0;
  double checkpoint_age_ = 0;  // time of the clock at the last checkpoint, or at the start of the loop [s]
  std::optional<State> good_;  // explicit: the copy of a good state
  double save_seconds_ = 0;    // duration of that copy [s]
  double saved_at_ = 0;        // time of the clock at that copy [s]
};

}  // namespace scree
