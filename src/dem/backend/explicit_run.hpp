// Explicit steps of the particles, one after the other without the state at rest in between.
#pragma once

#include <cstdint>
#include <vector>

#include "base/timer.hpp"
#include "base/types.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

inline bool is_verlet(const Model& model) {
  return model.integrator.particles == ParticleIntegrator::velocity_verlet;
}

// The particles' substep with velocity-Verlet [s]; 0 for HHT.
inline Real verlet_step(const Model& model) {
  return is_verlet(model) ? model.time.step / model.integrator.substeps : 0;
}

// How far ExplicitRun::take_steps came.
struct StepsTaken {
  Index closed = 0;   // steps
  bool open = false;  // whether the step after the last of them is open; else the state is at rest
};

// From Backend::start_run, which has opened the first step. All functions are collective (see Backend).
class ExplicitRun {
 public:
  virtual ~ExplicitRun() = default;

  // While a step is open: closes up to `most` and opens the one after each, the last of them only if
  // keep_open; it renews the list where needed. Bodies and walls stay where they were placed: with any
  // that move, or run, `most` is 1. Every Integrator::substeps from the start of the run a step of the bodies
  // ends: there it stops, closed, if a particle is outside the space.
  virtual StepsTaken take_steps(Index most, bool keep_open, StageTimers& timers) = 0;
  // Contacts of the bodies' shapes, where they are placed now, with the particles as they were when the last
  // step was closed.
  virtual void shape_contacts() = 0;
  // Contact wrenches on the bodies, after either of these, and the number of particles' contacts in each. On
  // rank 0; zero elsewhere.
  virtual void reduce_wrench(std::vector<BodyWrench>& wrench, std::vector<std::int64_t>& contacts) = 0;
};

}  // namespace scree
