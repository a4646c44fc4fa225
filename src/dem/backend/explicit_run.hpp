// A run of explicit steps of the particles, without a committed state between them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "base/timer.hpp"
#include "base/types.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

inline bool is_verlet(const Model& model) {
  return model.integrator.particles == ParticleIntegrator::velocity_verlet;
}

// Substep of the particles with velocity Verlet [s]; 0 for HHT.
inline Real verlet_step(const Model& model) {
  return is_verlet(model) ? model.time.step / model.integrator.substeps : 0;
}

// Progress of ExplicitRun::take_steps.
struct StepsTaken {
  Index closed = 0;   // closed steps
  bool open = false;  // whether the step after the last closed one is open; else the state is committed
};

// Returned by Backend::start_run, which has opened the first step. All functions are collective (see
// Backend).
class ExplicitRun {
 public:
  virtual ~ExplicitRun() = default;

  // While a step is open: closes up to `most` steps, and opens the next one after each, after the last only
  // if keep_open; rebuilds the list where needed. The surfaces keep their poses: `most` is 1 if any surface
  // moves or is a conveyor. Every Integrator::substeps from the start of the run a step of the bodies ends:
  // the run stops there, closed, if a particle is outside the domain.
  virtual StepsTaken take_steps(Index most, bool keep_open, StageTimers& timers) = 0;
  // The same in a model without bodies, for surfaces whose motion is known ahead. motion: of their parents at
  // the end of each step, [step][parent]; its length gives `most`. wrenches: of the contacts on the parents
  // at the end of each closed step, [step][parent]; on rank 0, zero elsewhere.
  virtual StepsTaken take_driven_steps(std::span<const BodyMotion> motion, bool keep_open,
                                       std::vector<BodyWrench>& wrenches, StageTimers& timers) = 0;
  // Evaluates the contacts of the bodies' shapes at their current poses, with the particles of the last
  // closed step.
  virtual void shape_contacts() = 0;
  // Work for the host, done once: by the next take_steps() or shape_contacts() of an asynchronous backend
  // while it would wait for the contacts with the bodies, else by do_work(). It must neither change the
  // backend nor throw.
  void set_work(std::function<void()> work) { work_ = std::move(work); }
  void do_work() {
    if (work_) std::exchange(work_, nullptr)();
  }
  // Contact wrenches on the bodies after take_steps() or shape_contacts(), and the number of particles'
  // contacts in each. On rank 0; zero elsewhere.
  virtual void reduce_wrench(std::vector<BodyWrench>& wrench, std::vector<std::int64_t>& contacts) = 0;

 private:
  std::function<void()> work_;
};

}  // namespace scree
