#include "output/series_triangles.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/index.hpp"

namespace scree {

namespace {

const std::string kRoot = "/VTKHDF/";
const std::string kCellData = "/VTKHDF/CellData/";

void write_once(Hdf5File& file, const std::string& name, const std::vector<std::int64_t>& values,
                const std::string& description) {
  file.create_rows<std::int64_t>(kRoot + name, {1, std::max<std::int64_t>(1, std::ssize(values))},
                                 {"1", description});
  file.append_rows(kRoot + name, values.data(), std::ssize(values));
}

// Creates the groups of kinds of cells that do not occur.
void create_no_cells(Hdf5File& file) {
  write_once(file, "Vertices/NumberOfCells", {0}, "cells of each part: none");
  write_once(file, "Vertices/Offsets", {0}, "one 0 per part");
  write_once(file, "Vertices/Connectivity", {}, "empty");
  file.link(kRoot + "Vertices/NumberOfCells", kRoot + "Vertices/NumberOfConnectivityIds");
  file.link(kRoot + "Vertices", kRoot + "Lines");
  file.link(kRoot + "Vertices", kRoot + "Strips");
}

void require_fields(const Hdf5File& file, const SeriesTriangles& triangles) {
  if (!triangles.fields) return;
  std::vector<std::string> held = file.dataset_names(kCellData), wanted = *triangles.fields;
  std::erase_if(held, [&](const std::string& name) { return triangles.has(name); });
  std::ranges::sort(held), std::ranges::sort(wanted);
  if (held == wanted) return;
  const auto words = [](const std::vector<std::string>& names) {
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
  };
  throw IoError(
      fmt::format("{}: has the fields {}, but the restarted run is to write {}; keep output.surface_fields "
                  "unchanged, or choose another folder",
                  file.path(), words(held), words(wanted)));
}

}  // namespace

bool SeriesTriangles::has(const std::string& name) const {
  return std::ranges::any_of(numbers, [&](const TriangleNumbers& of) { return of.name == name; });
}

void create_triangles(Hdf5File& file, const SeriesTriangles& triangles) {
  const std::int64_t count = triangles.count();
  std::vector<std::int64_t> offsets(as_size(count) + 1);
  for (std::size_t k = 0; k < offsets.size(); ++k) offsets[k] = 3 * static_cast<std::int64_t>(k);
  write_once(file, "Polygons/NumberOfCells", {count}, "triangles");
  write_once(file, "Polygons/NumberOfConnectivityIds", {3 * count}, "corners of triangles");
  write_once(file, "Polygons/Connectivity", triangles.corners, "points at the corners of each triangle");
  write_once(file, "Polygons/Offsets", offsets, "first corner of each triangle, and their number");
  create_no_cells(file);
  for (const TriangleNumbers& numbers : triangles.numbers) {
    file.create_rows<std::int32_t>(kCellData + numbers.name, {1, std::max<std::int64_t>(1, count)},
                                   {"1", numbers.description});
    file.append_rows(kCellData + numbers.name, numbers.values.data(), count);
    // All snapshots begin at row 0, which is also the number of the only part.
    file.link(kRoot + "Steps/PartOffsets", kRoot + "Steps/CellDataOffsets/" + numbers.name);
  }
}

void require_triangles(const Hdf5File& file, const SeriesTriangles& triangles) {
  bool same = file.read_array<std::int64_t>(kRoot + "Polygons/Connectivity") == triangles.corners;
  for (const TriangleNumbers& numbers : triangles.numbers)
    same = same && file.read_array<std::int32_t>(kCellData + numbers.name) == numbers.values;
  if (!same)
    throw IoError(
        file.path() +
        ": the triangles differ from those of the restarted run; keep the meshes unchanged, or choose "
        "another folder");
  require_fields(file, triangles);
}

}  // namespace scree
