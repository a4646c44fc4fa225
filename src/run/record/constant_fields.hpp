// Snapshot fields that the deck selects although they are constant in time.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

// The warning for selected fields of rotation in a model without rotating particles; otherwise empty.
std::string constant_fields(const Model& model);

}  // namespace scree
