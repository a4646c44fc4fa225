// An open implicit step of the particles: neither accepted nor undone.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "model/data/body_exchange.hpp"

namespace scree {

// Norms of one Newton iteration of the particles: dimensionless maxima over all particles.
struct ParticleNorms {
  Real residual = 0;  // over the largest force on a particle, at the iterate and at the start of the step
  // Bound of the position correction that the residual can still cause, over the radius.
  Real correction_bound = 0;
  bool overshoot = false;  // the last correction went too far along its direction
};

struct ParticleCorrection {
  Real correction = 0;  // largest position correction over the particle's radius
  int iterations = 0;   // of the linear solve
};

// Returned by Backend::open_step, which has saved the state. All functions are collective (see Backend).
class ImplicitStep {
 public:
  virtual ~ImplicitStep() = default;

  virtual void predict() = 0;  // called first
  // Largest displacement of a particle or surface since the start of the step [m].
  virtual Real step_displacement() = 0;
  virtual ParticleNorms contact_force() = 0;
  // Particle with the largest residual of the last contact_force; -1 without particles.
  virtual GlobalId worst_particle() = 0;
  // After contact_force: contact wrenches on the bodies, that the step is solved with and at its end; they
  // differ where contacts open or close within the step. On rank 0; zero elsewhere.
  virtual void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) = 0;
  virtual ParticleCorrection particle_correct() = 0;
  // Reverts part of the last correction, after contact_force has reported an overshoot.
  virtual void shorten_correction() = 0;
  // From now on the friction limits are those of the current iterate: such a step converges where one whose
  // limits follow the normal forces may not. For particles with friction; at most once a step, after
  // contact_force.
  virtual void lag_limits() {}
  virtual Real error() = 0;  // local position error of the step over the radius

  // Either function ends the step; no other function may be called afterwards. Destroying a step without
  // either leaves the particles where they are.
  virtual void accept() = 0;
  virtual void undo() = 0;  // restores the state before open_step, bit for bit
};

}  // namespace scree
