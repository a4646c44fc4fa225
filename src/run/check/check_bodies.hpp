// The lines of `scree check` on bodies.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

// Numbers of bodies, joints and unknowns, and the mass properties of bodies made of solids.
std::string multibody_lines(const Model& model);

// What the history leaves out because of the deck's limits on recorded entries; an empty text if it records
// all.
std::string history_limit_lines(const Model& model);

}  // namespace scree
