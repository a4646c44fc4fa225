// Size of the files of a VtkHdfSeries before they are written.
#pragma once

#include <string>

#include "output/vtkhdf_series.hpp"

namespace scree {

// Sizes of NAME.vtkhdf and NAME.xdmf with so many snapshots like this one, of which only the points may be
// missing [B]; for compressed files before compression. parts: number of parts; a new one begins when the
// number of particles or contacts changes.
struct SeriesSize {
  Real data = 0, xdmf = 0;
};
SeriesSize series_size(const std::string& name, const SeriesOptions& options, const PointSnapshot& like,
                       std::int64_t snapshots, std::int64_t parts);

}  // namespace scree
