// XDMF 3 text for readers that do not know VTKHDF (ParaView before 5.13). It refers to the .vtkhdf's
// datasets.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "output/vtkhdf_series.hpp"

namespace scree {

struct XdmfSeries {
  std::string name;
  std::string data_file;  // the .vtkhdf's name, in the same directory
  const std::vector<PointField>* fields = nullptr;
  const SeriesTriangles* triangles = nullptr;  // of a series of triangles: the fields are theirs
  bool lines = false;                          // of a series of lines, likewise
  std::span<const std::string> constant = {};  // fields of points that have the rows of the vertices
};

// One snapshot's <Grid>; empty for a snapshot without points, which these readers cannot open.
std::string xdmf_grid(const XdmfSeries& series, const SnapshotPlace& place);
// The whole document around the grids of all snapshots.
std::string xdmf_document(const std::string& name, const std::string& title, const std::string& grids);

}  // namespace scree
