// Triangles of a VTKHDF series: their connectivity is constant, their corners move.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "output/hdf5_file.hpp"

namespace scree {

// One number per triangle, constant in time.
struct TriangleNumbers {
  std::string name;
  std::string description;
  std::vector<int> values;
};

struct SeriesTriangles {
  std::vector<std::int64_t> corners;  // [triangles][3] points, counted from 0
  std::vector<TriangleNumbers> numbers;
  // Names of the fields of further snapshots, to be checked against files that are continued.
  std::optional<std::vector<std::string>> fields = {};

  std::int64_t count() const { return static_cast<std::int64_t>(corners.size()) / 3; }
  bool has(const std::string& name) const;  // whether it is one of `numbers`
};

// Creates the groups of cells in a new file, with the triangles as the only part of Polygons and the numbers
// in CellData.
void create_triangles(Hdf5File& file, const SeriesTriangles& triangles);
// Throws IoError if the file has other triangles or other fields.
void require_triangles(const Hdf5File& file, const SeriesTriangles& triangles);

}  // namespace scree
