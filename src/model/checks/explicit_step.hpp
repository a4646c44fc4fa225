// The rule of explicit steps: the one that is chosen where the deck leaves its step out, and that warnings
// and refusals name.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

struct ExplicitStep {
  Real step = kInfinity;  // time.step, whatever the deck says [s]; infinite where nothing bounds it
  std::string reason;     // what bounds it, for people
};

// The longest step with which velocity-verlet, in integrator.substeps of it,
// - keeps the trial rebounds of all pairs of materials within kGoodRebound (model/checks/impact_trials.hpp),
// - is at most kStableShare of what is stable in dense contact, with springs and dashpots along the normal,
//   across it and against rolling, and kNeckShare of a contact that a neck holds,
// - resolves the bodies on their contacts (BodyStepLimit::good_step, fastest_on_corners), and under as many
//   particles as can touch them (shortest_loaded_step),
// - and lets nothing go farther than half of the smallest radius (unnoticed_step);
// to two digits, rounded down: the deck that names it is the same deck.
ExplicitStep longest_explicit_step(const Model& model);

// Whether steps of this length [s] suit the contacts: stability, trial rebounds, bodies on single contacts
// and on the corners of their meshes.
bool suits_explicit(const Model& model, Real step);

// "; left out, it is 1.2e-05 s: ...": the remedy of a refusal or warning.
std::string left_out_step(const Model& model);

// Rounded down to two digits; x > 0.
Real two_digits_below(Real x);

}  // namespace scree
