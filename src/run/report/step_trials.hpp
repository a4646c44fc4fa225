// What check and run say of the impacts in the deck's steps.
#pragma once

#include <string>

#include "model/checks/impact_trials.hpp"

namespace scree {

// What check prints of one.
std::string trial_lines(const StepTrial& trial);
// Of the worst pair past kBadRebound; empty if there is none. Steps that adapt are left alone.
std::string step_warning(const Model& model);

}  // namespace scree
