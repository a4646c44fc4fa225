// Names and lengths of the datasets of a checkpoint.
#pragma once

#include <string>
#include <vector>

#include "model/data/model.hpp"
#include "output/checkpoint.hpp"
#include "run/state/state.hpp"

namespace scree {

// A state whose arrays are as long as this model's, except those of particles and contacts.
State sized_state(const Model& model);
// Throws IoError with file and dataset unless the datasets and their lengths are those of a state of this
// model. texts: names of the texts that the checkpoint has in addition.
void check_datasets(const Checkpoint& checkpoint, const Model& model, const std::vector<std::string>& texts);

}  // namespace scree
