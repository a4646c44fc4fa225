// How large a VtkHdfSeries gets, before it is written.
#pragma once

#include <string>

#include "output/vtkhdf_series.hpp"

namespace scree {

// The sizes of NAME.vtkhdf and NAME.xdmf with so many snapshots like this one, of which the points alone may
// be missing [B]. In compressed files: before compression. Particles that leave, and contacts whose number
// changes, begin new parts, of which `parts` are counted.
struct SeriesSize {
  Real data = 0, xdmf = 0;
};
SeriesSize series_size(const std::string& name, const SeriesOptions& options, const PointSnapshot& like,
                       std::int64_t snapshots, std::int64_t parts);

}  // namespace scree
