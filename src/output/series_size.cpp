#include "output/series_size.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "output/hdf5_size.hpp"
#include "output/xdmf.hpp"

namespace scree {
namespace {

constexpr std::int64_t kLong = sizeof(std::int64_t);

std::int64_t bytes_of(const PointField& field) {
  return std::holds_alternative<const int*>(field.values) ? sizeof(int) : kLong;
}

// Names: files contain the texts twice, and a reference to each.
void add_names(const SeriesNames& names, std::int64_t chunk, std::int64_t snapshots, Hdf5Size& size) {
  constexpr std::int64_t kReference = 16, kText = 32, kFewest = 4096;
  if (names.entries.empty()) return;
  const std::int64_t count = std::ssize(names.entries);
  std::int64_t letters = 0;
  for (const std::string& entry : names.entries) letters += std::ssize(entry) + 1;
  size.add_array(letters);
  size.add_array(kReference * count + std::max(kFewest, kText * count + letters));
  size.add_rows({1, chunk}, kLong, snapshots);
  size.add_rows({2, chunk}, kLong, snapshots);
}

// Datasets with one row per snapshot, or per part.
void add_steps(const SeriesOptions& options, std::int64_t snapshots, std::int64_t parts, Hdf5Size& size) {
  const std::int64_t chunk = steps_per_chunk(options);
  const bool of_cells = options.triangles || options.lines;
  const int numbers = 4 + (of_cells ? 1 : 0) + (options.constant.empty() ? 0 : 1);
  for (int k = 0; k < numbers; ++k) size.add_rows({1, chunk}, kLong, snapshots);
  for (int k = 0; k < (options.lines ? 2 : 1); ++k) size.add_rows({4, chunk}, kLong, snapshots);
  size.add_rows({1, chunk}, kLong, parts);  // NumberOfPoints
  if (options.lines) size.add_rows({1, chunk}, kLong, parts);
  const std::int64_t once = options.triangles ? 1 : parts;
  for (int k = 0; k < 2; ++k) size.add_rows({1, options.triangles ? 1 : chunk}, kLong, once);
  size.add_rows({1, chunk}, kLong, 0);
  for (const SeriesNames& names : options.names) add_names(names, chunk, snapshots, size);
}

void add_cells(const SeriesOptions& options, std::int64_t points, std::int64_t parts, Hdf5Size& size) {
  if (options.triangles) {
    const std::int64_t count = options.triangles->count();
    for (const std::int64_t rows : {std::int64_t{1}, std::int64_t{1}, 3 * count, count + 1})
      size.add_rows({1, rows}, kLong, rows);
    for (const TriangleNumbers& numbers : options.triangles->numbers)
      size.add_rows({1, std::max<std::int64_t>(1, std::ssize(numbers.values))}, sizeof(int), count);
    return;
  }
  const std::int64_t chunk = points_per_chunk(points, options), of_cell = options.lines ? 2 : 1;
  size.add_rows({1, chunk}, kLong, points * parts);
  size.add_rows({1, chunk}, kLong, (points / of_cell + 1) * parts);
}

void add_fields(const SeriesOptions& options, const PointSnapshot& like, std::int64_t snapshots,
                std::int64_t parts, Hdf5Size& size) {
  const std::int64_t count = options.triangles ? options.triangles->count()
                             : options.lines   ? like.points / 2
                                               : like.points;
  const std::int64_t chunk = points_per_chunk(options.triangles ? count : like.points, options);
  for (const PointField& field : like.fields) {
    const bool constant = std::ranges::find(options.constant, field.name) != options.constant.end();
    size.add_rows({field.width, chunk}, bytes_of(field), count * (constant ? parts : snapshots));
  }
}

}  // namespace

SeriesSize series_size(const std::string& name, const SeriesOptions& options, const PointSnapshot& like,
                       std::int64_t snapshots, std::int64_t parts) {
  constexpr int kSmallGroups = 8;  // Scree, Vertices, Lines, and of field data and offsets
  Hdf5Size size(options.likely_snapshots);
  add_steps(options, snapshots, parts, size);
  add_cells(options, like.points, parts, size);
  size.add_rows({3, points_per_chunk(like.points, options)}, kLong, like.points * snapshots);
  add_fields(options, like, snapshots, parts, size);
  for (int k = 0; k < kSmallGroups; ++k) size.add_group(4);
  for (int k = 0; k < 2; ++k) size.add_group(std::ssize(like.fields));
  const XdmfSeries series{name,          name + ".vtkhdf",
                          &like.fields,  options.triangles ? &*options.triangles : nullptr,
                          options.lines, options.constant};
  const std::int64_t middle = snapshots / 2;
  const std::string grid = xdmf_grid(series, {like.time, like.points, middle * like.points, 0, 0, middle});
  return {size.bytes(), static_cast<Real>(xdmf_document(name, options.title, "").size() +
                                          grid.size() * as_size(snapshots))};
}

}  // namespace scree
