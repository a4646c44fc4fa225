// The history's columns on the contacts of chosen bodies, rows of bodies and walls.
#pragma once

#include <vector>

#include "coupling/body_link.hpp"
#include "dem/backend.hpp"
#include "model/model.hpp"
#include "output/history.hpp"
#include "run/state.hpp"

namespace scree {

// One group "contacts/<name>" for each of Output::history_contacts.
void add_contact_columns(const Model& model, std::vector<HistoryColumn>& columns);

// Their values of one row, complete on rank 0. Collective. Asks the backend only for what is recorded.
void add_contact_values(const Model& model, const BodyLink& link, const State& state, Backend& backend,
                        std::vector<Real>& row);

}  // namespace scree
