// The loop over steps: reads from top to bottom as the algorithm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "base/log.hpp"
#include "coupling/coupled_step.hpp"
#include "run/state/records.hpp"
#include "run/state/state.hpp"
#include "run/state/step_clock.hpp"

namespace scree {

enum class LoopEnd { done, paused, stopped_by_signal };

// Since some moment, by the machine's clock.
double steady_seconds();

// What the loop works on; all of it outlives the loop.
struct LoopParts {
  const Model& model;
  Backend& backend;
  BodyLink& link;
  CoupledStep& step;
  Records& records;
  StageTimers& timers;
  std::function<double()> seconds = steady_seconds;  // a clock that never goes back
  // Called with the particles that leave the space, where they leave.
  std::function<void(const std::vector<Leaver>&)> leaving = [](const std::vector<Leaver>&) {};
};

// Explicit steps of the bodies to take at once, where the last ones took so many seconds each. mixed: that of
// the backend.
std::size_t batch_length(const Model& model, bool mixed, double step_seconds);

class StepLoop {
 public:
  // write_checkpoint: called with the complete state whenever one is due; may take its particles away.
  StepLoop(const LoopParts& parts, State& state, std::function<void(State&)> write_checkpoint,
           std::function<void(const State&, Real h)> progress);

  // Steps until the end or a signal, or pauses after the first step that reaches the time `until` [s]; may be
  // called again then. Throws SimulationError when the run cannot go on.
  LoopEnd run(Real until = kInfinity);
  int signal() const { return signal_; }  // that stopped it on some rank
  // The state as it is, complete with the particles.
  State& complete_state();
  // After a failure. Implicit: the start of the failed step. Explicit: a copy kept some steps ago, because an
  // explicit step cannot be undone.
  State& last_good_state();

 private:
  int look_outside();
  void write_checkpoint();
  void take_step(Real until);
  void reject(const StepOutcome& outcome);
  void take_explicit_steps(Real h, Real until);
  void close_step(Real h);
  void leave();
  void output(Real h);
  void keep_good_state();
  const Ranks& ranks() const { return parts_.link.ranks(); }

  LoopParts parts_;
  State& state_;
  StepClock clock_;
  std::function<void(State&)> write_checkpoint_;
  std::function<void(const State&, Real)> progress_;
  bool implicit_;
  double step_seconds_ = std::numeric_limits<double>::infinity();  // of the last explicit steps
  std::int64_t next_sample_ = 0;                                   // of the energies: a number of steps
  int signal_ = 0;
  double checkpoint_age_ = 0;  // steady clock when the last one was written, or the loop began [s]
  std::optional<State> good_;  // explicit: the copy
  double good_cost_ = 0;       // seconds that keeping it took
  double good_age_ = 0;        // steady clock when it was kept [s]
};

}  // namespace scree
