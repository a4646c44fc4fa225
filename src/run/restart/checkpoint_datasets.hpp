// Which datasets a checkpoint has, and how long they are.
#pragma once

#include <string>
#include <vector>

#include "model/data/model.hpp"
#include "output/checkpoint.hpp"
#include "run/state/state.hpp"

namespace scree {

// A state whose arrays, but for those of particles and contacts, are as long as this model's.
State sized_state(const Model& model);
// Throws IoError naming file and dataset where they are not those of a state of this model, each with its
// length. texts: that the checkpoint has besides.
void check_datasets(const Checkpoint& checkpoint, const Model& model, const std::vector<std::string>& texts);

}  // namespace scree
