#include "output/series_cells.hpp"

#include <string>
#include <vector>

#include "base/index.hpp"

namespace scree {

namespace {

const std::string kRoot = "/VTKHDF/";

// Writes k times `step` into row k of a part; numbers: the rows to write.
void write_numbers(SharedRows& file, const std::string& name, std::int64_t first_row, RowPart numbers,
                   std::int64_t step) {
  std::vector<std::int64_t> piece;
  file.write_pieces<std::int64_t>(name, 1, {first_row + numbers.first, numbers.count},
                                  [&](std::int64_t first, std::int64_t count) {
                                    piece.resize(as_size(count));
                                    std::int64_t k = numbers.first + first;
                                    for (std::int64_t& value : piece) value = step * k++;
                                    return piece.data();
                                  });
}

}  // namespace

void create_cells(Hdf5File& file, const SeriesCells& cells, const RowStorage& of_points,
                  std::int64_t parts_per_chunk) {
  const std::string own = kRoot + cells.group + "/", none = kRoot + cells.nothing;
  const auto create = [&](const std::string& name, const RowStorage& storage,
                          const std::string& description) {
    file.create_rows<std::int64_t>(name, storage, {"1", description});
  };
  const RowStorage of_parts{1, parts_per_chunk};
  create(own + "Connectivity", of_points, "points of each cell, counted from the part's first");
  create(own + "Offsets", of_points,
         "first connectivity id of each cell, and their number: one more row per part");
  file.link(kRoot + "NumberOfPoints", own + "NumberOfConnectivityIds");
  if (cells.points == 1)
    file.link(kRoot + "NumberOfPoints", own + "NumberOfCells");
  else
    create(own + "NumberOfCells", of_parts, "cells of each part");
  create(none + "/NumberOfCells", of_parts, "cells of each part: none");
  create(none + "/Offsets", of_parts, "one 0 per part");
  create(none + "/Connectivity", of_parts, "empty");
  file.link(none + "/NumberOfCells", none + "/NumberOfConnectivityIds");
  file.link(none, kRoot + "Polygons");
  file.link(none, kRoot + "Strips");
}

void add_cells(Hdf5File& file, const SeriesCells& cells, std::int64_t points) {
  const std::string own = kRoot + cells.group + "/", none = kRoot + cells.nothing;
  file.add_rows(own + "Connectivity", points);
  file.add_rows(own + "Offsets", points / cells.points + 1);
  if (cells.points > 1) file.append_row(own + "NumberOfCells", points / cells.points);
  file.append_row(none + "/NumberOfCells", std::int64_t{0});
  file.append_row(none + "/Offsets", std::int64_t{0});
}

void cut_cells(Hdf5File& file, const SeriesCells& cells, const PartRows& last, std::int64_t points) {
  const std::string own = kRoot + cells.group + "/", none = kRoot + cells.nothing;
  const std::int64_t parts = last.part + 1, count = last.first_cell + points / cells.points;
  if (cells.points > 1) file.resize_rows(own + "NumberOfCells", parts);
  for (const char* name : {"/NumberOfCells", "/Offsets"}) file.resize_rows(none + name, parts);
  file.resize_rows(own + "Connectivity", cells.points * count);
  file.resize_rows(own + "Offsets", count + parts);
}

void write_cells(SharedRows& file, const SeriesCells& cells, const PartRows& place, RowPart points,
                 bool has_end) {
  const std::string own = kRoot + cells.group + "/";
  write_numbers(file, own + "Connectivity", cells.points * place.first_cell, points, 1);
  write_numbers(file, own + "Offsets", place.first_cell + place.part,
                {points.first / cells.points, points.count / cells.points + (has_end ? 1 : 0)}, cells.points);
}

}  // namespace scree
