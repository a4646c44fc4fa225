// XDMF 3 text for readers without VTKHDF support (ParaView before 5.13); it refers to the datasets of the
// .vtkhdf.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "output/vtkhdf_series.hpp"

namespace scree {

struct XdmfSeries {
  std::string name;
  std::string data_file;  // name of the .vtkhdf in the same folder
  const std::vector<PointField>* fields = nullptr;
  const SeriesTriangles* triangles = nullptr;  // for a series of triangles, to which the fields belong
  bool lines = false;                          // for a series of lines, to which the fields belong
  std::span<const std::string> constant = {};  // fields of points with one row per vertex
};

// <Grid> of one snapshot; empty for a snapshot without points, which these readers cannot open.
std::string xdmf_grid(const XdmfSeries& series, const SnapshotRows& place);
// The complete document around the grids of all snapshots.
std::string xdmf_document(const std::string& name, const std::string& title, const std::string& grids);

}  // namespace scree
