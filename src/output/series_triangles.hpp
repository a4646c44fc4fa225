// The triangles of a VTKHDF series: what does not change while their corners move.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "output/hdf5_file.hpp"

namespace scree {

// One number per triangle, written once.
struct TriangleNumbers {
  std::string name;
  std::string description;
  std::vector<int> values;
};

struct SeriesTriangles {
  std::vector<std::int64_t> corners;  // [triangles][3] points, counted from 0
  std::vector<TriangleNumbers> numbers;
  // Of the snapshots to come, where files that are continued are to be looked at for them.
  std::optional<std::vector<std::string>> fields = {};

  std::int64_t count() const { return static_cast<std::int64_t>(corners.size()) / 3; }
  bool has(const std::string& name) const;  // of the numbers
};

// In a new file: the groups of cells with these, the only part, in Polygons, and the numbers in CellData.
void create_triangles(Hdf5File& file, const SeriesTriangles& triangles);
// Throws IoError where the file holds others, or other fields.
void require_triangles(const Hdf5File& file, const SeriesTriangles& triangles);

}  // namespace scree
