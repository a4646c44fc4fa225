// Trial impacts of the deck's materials: the lightest partners of each pair collide in the steps of a run
// (physics/trial_impact.hpp).
#pragma once

#include <memory>
#include <vector>

#include "model/checks/limits.hpp"
#include "physics/trial_impact.hpp"

namespace scree {

// Trial impact of one pair of materials.
struct StepTrial {
  PairLimit limit;
  Real speed;  // impact speed [m/s]; without effect where the force is linear in the overlap
  Real step;   // the particles' step, or the step that adaptive control arrives at [s]
  bool is_adaptive;
  bool is_frictional;  // with friction: an impact without spin at `incidence`; otherwise head-on
  Real incidence;      // angle from the normal [rad]
  TrialResult result;
  Real good_step;      // largest step with errors below kReboundTolerance [s]
  bool any_step_good;  // good_step is the longest step that was tried
  Real adaptive_step;  // step that adaptive implicit control would choose; 0: control is adaptive already, or
                       // explicit [s]
  Real adaptive_error;  // error of rebounds in such steps
};

// Errors of rebound speeds: the limit for chosen steps, and the limit for a warning.
inline constexpr Real kReboundTolerance = 0.02, kBadRebound = 0.05;

// One trial per pair of materials that can meet and interact, with its lightest partners: two particles if
// possible, otherwise a particle and a body or a wall, otherwise bodies. Empty for contacts that are not
// integrated in these steps: those between bodies beside explicit particles.
std::vector<StepTrial> try_steps(const Model& model);

// The pairs of materials whose contacts velocity-verlet integrates. The model needs no step and no integrator
// yet.
std::vector<PairLimit> explicit_pairs(const Model& model);

// Trials of such pairs. Pairs with equal laws and partners are tried once.
class ExplicitTrials {
 public:
  // `model` must outlive the trials.
  explicit ExplicitTrials(const Model& model);
  ~ExplicitTrials();

  // The longest step of the particles for which the error of the pair's trial is within kReboundTolerance
  // [s].
  Real good_step(const PairLimit& limit);
  // The error of the pair's rebound in steps of `step` [s].
  Real error(const PairLimit& limit, Real step);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree
