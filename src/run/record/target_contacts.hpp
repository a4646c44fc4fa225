// Contact sums of selected bodies, rows of bodies and walls for the history.
#pragma once

#include <vector>

#include "coupling/body_coupling.hpp"
#include "dem/backend/backend.hpp"
#include "model/data/model.hpp"
#include "run/state/state.hpp"

namespace scree {

// One entry per element of Output::history_contacts, at the current instant; complete on rank 0. Collective.
// Requests only recorded quantities from the backend.
std::vector<ContactSum> target_contacts(const Model& model, const BodyCoupling& link, const State& state,
                                        Backend& backend);

}  // namespace scree
