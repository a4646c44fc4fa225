// Trial impacts of the deck's own materials: each pair's lightest partners meet in the steps that a run takes
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
  Real speed;  // of approach [m/s]; nothing depends on it where the force is linear in the overlap
  Real step;   // tried: that of the particles, or the one that adaptive steps come to [s]
  bool is_adaptive;
  bool rubs;       // with friction: an impact without spin at `incidence`, else head-on
  Real incidence;  // from the normal [rad]
  TrialResult result;
  Real good_step;       // up to which errors stay below kGoodRebound [s]
  bool any_step_good;   // good_step is the longest that was tried
  Real adaptive_step;   // that implicit steps would come to [s]; 0: they adapt already, or are explicit
  Real adaptive_error;  // of rebounds in such steps
};

// Errors of rebounds: what is good, which is what steps that are chosen keep to, and from where on there is a
// warning.
inline constexpr Real kGoodRebound = 0.02, kBadRebound = 0.05;

// One per pair of materials that can meet and interact; of its lightest partners, two particles if such can
// meet, else a particle and a body or a wall, else bodies. Empty for what is not in these steps: bodies among
// themselves beside explicit particles.
std::vector<StepTrial> try_steps(const Model& model);

// The pairs of materials whose contacts velocity-verlet takes. These need no step and no integrator of the
// model yet.
std::vector<PairLimit> explicit_pairs(const Model& model);

// Trials of such pairs. Pairs that are alike in their law and their partners are tried once.
class ExplicitTrials {
 public:
  // `model` must outlive the trials.
  explicit ExplicitTrials(const Model& model);
  ~ExplicitTrials();

  // The longest step of the particles up to which a pair's trial is within kGoodRebound [s].
  Real good_step(const PairLimit& limit);
  // The error of its rebound in steps of `step` [s].
  Real error(const PairLimit& limit, Real step);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree
