// What the deck's steps make of impacts of its own materials.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/limits.hpp"
#include "physics/trial_impact.hpp"

namespace scree {

// Of one pair of materials.
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

// Errors of rebounds: what is good, and from where on there is a warning.
inline constexpr Real kGoodRebound = 0.01, kBadRebound = 0.05;

// One per pair of materials that can meet and interact; of its lightest partners, two particles if such can
// meet, else a particle and a body or a wall, else bodies. Empty for what is not in these steps: bodies among
// themselves beside explicit particles.
std::vector<StepTrial> try_steps(const Model& model);

// What check prints of one.
std::string trial_lines(const StepTrial& trial);
// Of the worst pair past kBadRebound; empty if there is none. Steps that adapt are left alone.
std::string step_warning(const Model& model);

}  // namespace scree
