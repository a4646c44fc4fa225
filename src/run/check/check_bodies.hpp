// What the report of `scree check` says of bodies.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

// Numbers of bodies, joints and unknowns; of bodies made of solids what follows from these.
std::string multibody_lines(const Model& model);

// What the history leaves out because there are more than it is to record; "" where it records all.
std::string history_limit_lines(const Model& model);

}  // namespace scree
