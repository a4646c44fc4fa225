// An implicit step of the particles that is open: neither accepted nor undone.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "model/data/body_exchange.hpp"

namespace scree {

// Norms of one Newton iteration of the particles, scaled and dimensionless, maxima over all particles.
struct ParticleNorms {
  Real residual = 0;  // over the largest force on a particle, at the iterate and at the start of the step
  Real correction_bound = 0;  // of the position correction that the residual can still cause, over the radius
  bool overshoot = false;     // the last correction went too far along its direction
};

struct ParticleCorrection {
  Real correction = 0;  // largest position correction over the particle's radius
  int iterations = 0;   // of the linear solve
};

// From Backend::open_step, which has put the state aside. All functions are collective (see Backend).
class ImplicitStep {
 public:
  virtual ~ImplicitStep() = default;

  virtual void predict() = 0;            // first
  virtual Real step_displacement() = 0;  // largest of a particle or surface since the step's start [m]
  virtual ParticleNorms contact_force() = 0;
  // The particle with the largest residual in the last contact_force; -1 without particles.
  virtual GlobalId worst_particle() = 0;
  // After contact_force: contact wrenches on the bodies, what the step needs and at its end (equal unless
  // contacts open or close within it). On rank 0; zero elsewhere.
  virtual void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) = 0;
  virtual ParticleCorrection particle_correct() = 0;
  // Takes part of the last correction back, after contact_force has reported an overshoot.
  virtual void shorten_correction() = 0;
  // From now on friction's limits stay what they are at the iterate: a step that converges where one whose
  // limits follow the normal forces may not. Of particles that rub; at most once a step, after contact_force.
  virtual void freeze_limits() {}
  virtual Real error() = 0;  // local position error of the step over the radius

  // Either ends the step: nothing else may be called then. A step that goes without either leaves the
  // particles where they are.
  virtual void accept() = 0;
  virtual void undo() = 0;  // the state is that of before open_step, to the bit
};

}  // namespace scree
