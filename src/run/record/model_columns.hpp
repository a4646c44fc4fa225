// The columns of the history by names alone, without a run.
#pragma once

#include <vector>

#include "model/data/model.hpp"
#include "run/record/history_columns.hpp"

namespace scree {

// The columns of a run of the model, in their order; their names are complete, their units and texts not.
std::vector<RecordedColumn> model_columns(const Model& model);

}  // namespace scree
