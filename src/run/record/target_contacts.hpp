// What the history says of the contacts of chosen bodies, rows of bodies and walls.
#pragma once

#include <vector>

#include "coupling/body_link.hpp"
#include "dem/backend/backend.hpp"
#include "model/data/model.hpp"
#include "run/state/state.hpp"

namespace scree {

// One entry for each of Output::history_contacts, at this instant; complete on rank 0. Collective. Asks the
// backend only for what is recorded.
std::vector<ContactSum> target_contacts(const Model& model, const BodyLink& link, const State& state,
                                        Backend& backend);

}  // namespace scree
