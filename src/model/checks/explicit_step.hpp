// The explicit step: chosen where the deck leaves it out, and named in warnings and refusals.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

struct ExplicitStep {
  Real step = kInfinity;  // time.step, independent of the deck's value [s]; infinite where nothing bounds it
  std::string reason;     // the bound, for the user
};

// The longest step for which velocity-verlet, with integrator.substeps substeps per step,
// - keeps the trial rebounds of all pairs of materials within kReboundTolerance
//   (model/checks/impact_trials.hpp),
// - uses at most kStableStepFraction of the stability limit in dense contact, with springs and dashpots along
//   the normal, tangential and against rolling, and at most kPullOffShare of the duration of a JKR contact,
//   and the longest step that the law's own force needs (OwnParameters::longest_step),
// - resolves the oscillation of bodies on their contacts (BodyStepLimit::good_step, fastest_on_corners), and
//   with the largest number of particles that can touch them (shortest_loaded_step),
// - and moves nothing by more than half of the smallest radius (unnoticed_step).
// Rounded down to two digits, so that a deck that gives the printed step has the same step.
ExplicitStep longest_explicit_step(const Model& model);

// Whether steps of this length [s] satisfy the limits of the contacts: stability, trial rebounds, and bodies
// on single contacts and on the vertices of their meshes.
bool suits_explicit(const Model& model, Real step);

// "; left out, it is 1.2e-05 s: ...": advice for a refusal or warning.
std::string default_step_text(const Model& model);

// Rounded down to two digits; x > 0.
Real two_digits_below(Real x);

}  // namespace scree
