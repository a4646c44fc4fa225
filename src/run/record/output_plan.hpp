// What a run writes, as the deck has it planned: how often, and how its files are laid out.
#pragma once

#include <cstdint>
#include <vector>

#include "dem/reports/output_fields.hpp"
#include "model/data/model.hpp"
#include "output/vtkhdf_series.hpp"

namespace scree {

// Snapshots: at the start, at every interval, and at the end; an end that an interval meets counts once.
std::int64_t likely_snapshots(const Model& model);
// Rows of the history, likewise; of a row per step where steps are fixed. 0: not known.
std::int64_t likely_rows(const Model& model);
// Of a row per step where steps adapt, if nothing ever touches.
std::int64_t fewest_rows(const Model& model);

// Of new files, on one rank; triangles are left out.
SeriesOptions series_options(const Model& model);
// Views of the values of the fields that the deck wants, in its order.
std::vector<PointField> point_fields(const Output& output, const std::vector<OutputValues>& values);

}  // namespace scree
