#include "output/vtkhdf_series.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/version.hpp"
#include "output/durable_file.hpp"
#include "output/xdmf.hpp"

namespace scree {

namespace {

const std::string kRoot = "/VTKHDF/";
const std::string kSteps = "/VTKHDF/Steps/";
const std::string kPointData = "/VTKHDF/PointData/";
const std::string kCellData = "/VTKHDF/CellData/";
const std::string kPointDataOffsets = "/VTKHDF/Steps/PointDataOffsets/";
const std::string kCellDataOffsets = "/VTKHDF/Steps/CellDataOffsets/";
const std::string kConstantOffsets = kSteps + "ConstantOffsets";
// The .xdmf is rewritten when it has grown by one snapshot in this many.
constexpr std::size_t kXdmfGrowth = 5;

void create_field(Hdf5File& file, const std::string& name, const PointField& field, RowStorage storage) {
  storage.width = field.width;
  const auto create = [&]<class T>(const T*) { file.create_rows<T>(name, storage, field.label); };
  std::visit(create, field.values);
}

void write_field(SharedRows& file, const std::string& name, const PointField& field, RowPart part) {
  const auto write = [&](const auto* values) { file.write(name, field.width, part, values); };
  std::visit(write, field.values);
}

// For cells of one point the connectivity ids equal the numbers of the cells; for triangles both are 0.
void create_steps(Hdf5File& file, bool shared_ids, std::int64_t chunk) {
  const auto create = [&]<class T>(T, const std::string& name, int width, const std::string& unit,
                                   const std::string& description) {
    file.create_rows<T>(kSteps + name, {width, chunk}, {unit, description});
  };
  create(Real{}, "Values", 1, "s", "time of each snapshot");
  create(std::int64_t{}, "PartOffsets", 1, "1", "part that holds the cells of each snapshot");
  create(std::int64_t{}, "NumberOfParts", 1, "1", "parts of each snapshot");
  create(std::int64_t{}, "PointOffsets", 1, "1",
         "first row of each snapshot in Points and in fields of points");
  create(std::int64_t{}, "CellOffsets", 4, "1",
         "first cell of each snapshot: vertices, lines, polygons, strips");
  if (shared_ids)
    file.link(kSteps + "CellOffsets", kSteps + "ConnectivityIdOffsets");
  else
    create(std::int64_t{}, "ConnectivityIdOffsets", 4, "1",
           "first connectivity id of each snapshot, likewise");
  file.write_integer_attribute(kSteps, "NSteps", {0});
}

// Removes the triangle fields after so many snapshots.
void cut_triangles(Hdf5File& file, const SeriesTriangles& triangles, std::int64_t snapshots) {
  for (const std::string& name : file.dataset_names(kCellData)) {
    if (!triangles.has(name)) file.resize_rows(kCellData + name, snapshots * triangles.count());
  }
}

}  // namespace

// A run continued past its end adds chunks of the same length, so that they must not be too short.
std::int64_t steps_per_chunk(const SeriesOptions& options) {
  constexpr std::int64_t kFewest = 16, kMost = 128;
  return options.likely_snapshots == 0 ? kMost : std::clamp(options.likely_snapshots, kFewest, kMost);
}

std::int64_t points_per_chunk(std::int64_t points, const SeriesOptions& options) {
  constexpr std::int64_t kFewest = 128, kMost = 65536, kMostLikely = 8192;
  const std::int64_t often = std::max(points, std::min(options.likely_points, kMostLikely));
  if (often >= kFewest) return even_chunk(often, kMost);
  if (options.likely_snapshots == 0) return kFewest;
  return std::clamp<std::int64_t>(often * options.likely_snapshots, 16, kFewest);
}

VtkHdfSeries::VtkHdfSeries(const std::string& directory, const std::string& name,
                           const SeriesOptions& options)
    : name_(name),
      xdmf_path_(directory + "/" + name + ".xdmf"),
      options_(options),
      file_(directory + "/" + name + ".vtkhdf", options.ranks, options.likely_snapshots) {
  const int keep = options.keep;
  if (keep == 0 || !file_.exists()) {
    file_.remove();
    remove_xdmf();
    return;
  }
  options.ranks.collectively([&] {
    read_snapshot_rows();
    if (options.fields) require_fields();
    if (options.triangles) require_triangles(Hdf5File(path(), Hdf5Access::read), *options.triangles);
  });
  if (snapshots() < keep) {
    throw IoError(
        fmt::format("{}: has {} snapshots, but the restarted run has written {}", path(), snapshots(), keep));
  }
  if (snapshots() > keep) cut(as_size(keep));
}

void VtkHdfSeries::read_snapshot_rows() {
  const Hdf5File file(path(), Hdf5Access::read);
  const auto time = file.read_array<Real>(kSteps + "Values");
  const auto part = file.read_array<std::int64_t>(kSteps + "PartOffsets");
  const auto first_point = file.read_array<std::int64_t>(kSteps + "PointOffsets");
  const auto first_cell = file.read_array<std::int64_t>(kSteps + "CellOffsets");
  const auto points = file.read_array<std::int64_t>(kRoot + "NumberOfPoints");
  require_constant_offsets(file);
  if (part.size() != time.size() || first_point.size() != time.size() ||
      first_cell.size() != 4 * time.size()) {
    throw IoError(fmt::format("{}: the datasets in {} differ in length", path(), kSteps));
  }
  places_.resize(time.size());
  for (std::size_t s = 0; s < time.size(); ++s) {
    if (part[s] < 0 || part[s] >= static_cast<std::int64_t>(points.size())) {
      throw IoError(
          fmt::format("{}: snapshot {} refers to part {} of {}", path(), s, part[s], points.size()));
    }
    places_[s] = {time[s],
                  points[as_size(part[s])],
                  first_point[s],
                  part[s],
                  first_cell[4 * s + as_size(cells().column)],
                  static_cast<std::int64_t>(s)};
  }
}

// Earlier versions wrote every field at every snapshot.
void VtkHdfSeries::require_constant_offsets(const Hdf5File& file) const {
  const std::vector<std::string> steps = file.dataset_names(kSteps);
  if (options_.constant.empty() || std::ranges::find(steps, "ConstantOffsets") != steps.end()) return;
  throw IoError(path() + ": was written by an earlier version of the program; choose another folder");
}

void VtkHdfSeries::require_fields() const {
  std::vector<std::string> held = Hdf5File(path(), Hdf5Access::read).dataset_names(field_group()),
                           wanted = *options_.fields;
  std::ranges::sort(held), std::ranges::sort(wanted);
  if (held == wanted) return;
  throw IoError(
      fmt::format("{}: has the fields {}, but the restarted run is to write {}; {}choose another folder",
                  path(), fmt::join(held, ", "), fmt::join(wanted, ", "),
                  options_.lines ? "" : "keep output.fields unchanged, or "));
}

// A missing field means a file of another version, or of another deck.
void VtkHdfSeries::require_fields_of(const Hdf5File& file, const PointSnapshot& snapshot) const {
  const std::vector<std::string> held = file.dataset_names(field_group());
  for (const PointField& field : snapshot.fields)
    if (std::ranges::find(held, field.name) == held.end())
      throw IoError(
          fmt::format("{}: lacks the field {}, which this version of the program writes; "
                      "choose another folder",
                      path(), field.name));
}

void VtkHdfSeries::cut(std::size_t keep) {
  remove_xdmf();  // it would refer to removed rows; the next append writes it
  places_.resize(keep);
  const SnapshotRows last = places_.back();
  const std::int64_t steps = static_cast<std::int64_t>(keep);
  const auto shorten = [&](Hdf5File& file) {
    file.write_integer_attribute(kSteps, "NSteps", {steps});
    for (const char* name : {"Values", "PartOffsets", "NumberOfParts", "PointOffsets", "CellOffsets"}) {
      file.resize_rows(kSteps + name, steps);
    }
    if (has_cell_fields()) file.resize_rows(field_offsets(), steps);
    if (!options_.constant.empty()) file.resize_rows(kConstantOffsets, steps);
    cut_names(file, steps);
    file.resize_rows(kRoot + "Points", last.first_point + last.points);
    if (options_.triangles)
      cut_triangles(file, *options_.triangles, steps);
    else
      cut_points(file);
  };
  file_.update({shorten, {}});
}

// Removes rows after the last snapshot: cells, and the fields of cells or points.
void VtkHdfSeries::cut_points(Hdf5File& file) const {
  const SnapshotRows& last = places_.back();
  file.resize_rows(kRoot + "NumberOfPoints", last.part + 1);
  cut_cells(file, cells(), {last.part, last.first_cell}, last.points);
  if (options_.lines) file.resize_rows(kSteps + "ConnectivityIdOffsets", last.number + 1);
  for (const std::string& name : file.dataset_names(field_group())) {
    const RowPart rows = field_rows(last, {0, last.points}, name);
    file.resize_rows(field_group() + name, rows.first + rows.count);
  }
}

void VtkHdfSeries::lay_out(Hdf5File& file, const PointSnapshot& first) const {
  const std::int64_t steps = steps_per_chunk(options_);
  const RowStorage storage{1, points_per_chunk(first.points, options_), true, options_.compression};
  file.create_group(kSteps);
  file.write_integer_attribute("/VTKHDF", "Version", {2, 0});
  file.write_text_attribute("/VTKHDF", "Type", "PolyData");
  create_steps(file, !options_.lines, steps);
  file.create_rows<std::int64_t>(kRoot + "NumberOfPoints", {1, steps}, {"1", "points of each part"});
  if (options_.triangles)
    create_triangles(file, *options_.triangles);
  else
    create_cells(file, cells(), storage, steps);
  RowStorage vectors = storage;
  vectors.width = 3;
  file.create_rows<Real>(kRoot + "Points", vectors, {"m", "position"});
  lay_out_fields(file, first, storage);
  file.create_group("/Scree");
  file.write_text_attribute("/Scree", "title", options_.title);
  file.write_text_attribute("/Scree", "version", version());
  file.write_text_attribute("/Scree", "commit", commit());
  for (const SeriesNames& names : options_.names) create_names(file, names, steps);
}

void VtkHdfSeries::lay_out_fields(Hdf5File& file, const PointSnapshot& first, RowStorage storage) const {
  const std::int64_t steps = steps_per_chunk(options_);
  if (options_.triangles) storage.chunk_rows = points_per_chunk(options_.triangles->count(), options_);
  if (has_cell_fields())
    file.create_rows<std::int64_t>(field_offsets(), {1, steps},
                                   {"1", "first row of each snapshot in the fields of its cells"});
  if (!options_.constant.empty())
    file.create_rows<std::int64_t>(
        kConstantOffsets, {1, steps},
        {"1", "first row of each snapshot in the fields that never change of a point"});
  for (const PointField& field : first.fields) {
    create_field(file, field_group() + field.name, field, storage);
    file.link(is_constant(field.name) ? kConstantOffsets : field_offsets(),
              (has_cell_fields() ? kCellDataOffsets : kPointDataOffsets) + field.name);
  }
}

SnapshotRows VtkHdfSeries::next_rows(const PointSnapshot& snapshot) const {
  SnapshotRows place{snapshot.time, snapshot.points, 0, 0, 0, std::ssize(places_)};
  if (places_.empty()) return place;
  const SnapshotRows& last = places_.back();
  place.first_point = last.first_point + last.points;
  const bool same_part = last.points == snapshot.points;
  place.part = same_part ? last.part : last.part + 1;
  place.first_cell = same_part ? last.first_cell : last.first_cell + last.points / cells().points;
  return place;
}

bool VtkHdfSeries::starts_part(const SnapshotRows& place) const {
  return places_.empty() || place.part != places_.back().part;
}

const std::string& VtkHdfSeries::field_group() const { return has_cell_fields() ? kCellData : kPointData; }

// Time-dependent fields of points have as many rows as Points, and thus the same offsets.
std::string VtkHdfSeries::field_offsets() const {
  return kSteps + (options_.triangles ? "TriangleOffsets" : options_.lines ? "LineOffsets" : "PointOffsets");
}

bool VtkHdfSeries::is_constant(const std::string& field) const {
  return std::ranges::find(options_.constant, field) != options_.constant.end();
}

bool VtkHdfSeries::adds_rows(const SnapshotRows& place, const std::string& field) const {
  return !is_constant(field) || starts_part(place);
}

RowPart VtkHdfSeries::field_rows(const SnapshotRows& place, RowPart own, const std::string& field) const {
  if (options_.triangles) return {place.number * options_.triangles->count(), options_.triangles->count()};
  if (is_constant(field)) return {place.first_cell + own.first, own.count};  // same rows as the vertices
  return {(place.first_point + own.first) / cells().points, own.count / cells().points};
}

void VtkHdfSeries::append_cell_offsets(Hdf5File& file, std::int64_t first_cell) const {
  std::int64_t first[4] = {};
  first[cells().column] = first_cell;
  file.append_rows(kSteps + "CellOffsets", first, 1);
  first[cells().column] *= cells().points;
  if (options_.lines) file.append_rows(kSteps + "ConnectivityIdOffsets", first, 1);
}

void VtkHdfSeries::reserve_entries(Hdf5File& file, const PointSnapshot& snapshot,
                                   const SnapshotRows& place) const {
  if (places_.empty()) lay_out(file, snapshot);
  require_fields_of(file, snapshot);
  append_names(file);
  if (starts_part(place)) {
    file.append_row(kRoot + "NumberOfPoints", snapshot.points);
    if (!options_.triangles) add_cells(file, cells(), snapshot.points);
  }
  file.add_rows(kRoot + "Points", snapshot.points);
  for (const PointField& field : snapshot.fields)
    if (adds_rows(place, field.name))
      file.add_rows(field_group() + field.name, field_rows(place, {0, snapshot.points}, field.name).count);
  file.append_row(kSteps + "Values", snapshot.time);
  file.append_row(kSteps + "PartOffsets", place.part);
  file.append_row(kSteps + "NumberOfParts", std::int64_t{1});
  file.append_row(kSteps + "PointOffsets", place.first_point);
  if (has_cell_fields()) file.append_row(field_offsets(), field_rows(place, {0, snapshot.points}, "").first);
  if (!options_.constant.empty()) file.append_row(kConstantOffsets, place.first_cell);
  append_cell_offsets(file, place.first_cell);
  file.write_integer_attribute(kSteps, "NSteps", {static_cast<std::int64_t>(places_.size()) + 1});
}

void VtkHdfSeries::write_rows(SharedRows& file, const PointSnapshot& snapshot,
                              const SnapshotRows& place) const {
  const RowPart own = snapshot.own;
  if (starts_part(place) && !options_.triangles)
    write_cells(file, cells(), {place.part, place.first_cell}, own,
                options_.ranks.rank() == options_.ranks.size() - 1);
  file.write(kRoot + "Points", 3, {place.first_point + own.first, own.count}, snapshot.position);
  for (const PointField& field : snapshot.fields)
    if (adds_rows(place, field.name))
      write_field(file, field_group() + field.name, field, field_rows(place, own, field.name));
}

DoubleBufferedFile::Change VtkHdfSeries::change(const PointSnapshot& snapshot) const {
  const SnapshotRows place = next_rows(snapshot);
  return {[this, &snapshot, place](Hdf5File& file) { reserve_entries(file, snapshot, place); },
          [this, &snapshot, place](SharedRows& file) { write_rows(file, snapshot, place); }};
}

void VtkHdfSeries::prepare(const PointSnapshot& snapshot) { file_.prepare(change(snapshot)); }

void VtkHdfSeries::show() { file_.show(); }

void VtkHdfSeries::follow(const PointSnapshot& snapshot) {
  file_.follow(change(snapshot));
  places_.push_back(next_rows(snapshot));
  options_.ranks.on_root([&] { add_xdmf(snapshot); });
}

void VtkHdfSeries::remove_xdmf() const {
  if (!options_.ranks.is_root()) return;
  std::error_code none_there;
  std::filesystem::remove(xdmf_path_, none_there);
}

void VtkHdfSeries::add_xdmf(const PointSnapshot& snapshot) {
  const XdmfSeries series{name_,
                          name_ + ".vtkhdf",
                          &snapshot.fields,
                          options_.triangles ? &*options_.triangles : nullptr,
                          options_.lines,
                          options_.constant};
  for (; xdmf_snapshots_ < places_.size(); ++xdmf_snapshots_) {
    xdmf_grids_ += xdmf_grid(series, places_[xdmf_snapshots_]);
  }
  if (xdmf_snapshots_ > xdmf_written_ + xdmf_written_ / kXdmfGrowth) write_xdmf();
}

void VtkHdfSeries::write_xdmf() {
  write_text_file(xdmf_path_, xdmf_document(name_, options_.title, xdmf_grids_));
  xdmf_written_ = xdmf_snapshots_;
}

void VtkHdfSeries::finish() {
  options_.ranks.on_root([&] {
    if (xdmf_written_ < xdmf_snapshots_) write_xdmf();
  });
}

}  // namespace scree
