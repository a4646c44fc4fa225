// The files of a run as planned from the deck: numbers of outputs and layout.
#pragma once

#include <cstdint>
#include <vector>

#include "dem/reports/output_fields.hpp"
#include "model/data/model.hpp"
#include "output/vtkhdf_series.hpp"

namespace scree {

// Number of snapshots: at the start, at every interval, and at the end; an end at a multiple of the interval
// counts once.
std::int64_t likely_snapshots(const Model& model);
// Number of rows of the history, counted likewise, or one per fixed step. 0: not known.
std::int64_t likely_rows(const Model& model);
// The least number of rows: with adaptive steps and one row per step the number without any contact.
std::int64_t fewest_rows(const Model& model);

// Options of new files on one rank, without triangles.
SeriesOptions series_options(const Model& model);
// Views of the values of the fields that the deck selects, in its order.
std::vector<PointField> point_fields(const Output& output, const std::vector<OutputValues>& values);

}  // namespace scree
