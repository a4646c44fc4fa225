// Texts of `scree check` and of a run on the accuracy of impacts in the deck's steps.
#pragma once

#include <string>

#include "model/checks/impact_trials.hpp"

namespace scree {

// The lines of `scree check` on one trial.
std::string rebound_lines(const StepTrial& trial);
// The warning for the worst pair whose error is above kBadRebound; empty if there is none, and for adaptive
// steps.
std::string step_warning(const Model& model);

}  // namespace scree
