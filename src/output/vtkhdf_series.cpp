#include "output/vtkhdf_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "base/error.hpp"
#include "base/version.hpp"
#include "output/durable_file.hpp"
#include "output/xdmf.hpp"

namespace scree {

namespace {

const std::string kRoot = "/VTKHDF/";
const std::string kSteps = "/VTKHDF/Steps/";
const std::string kPointData = "/VTKHDF/PointData/";
constexpr std::int64_t kStepsPerChunk = 128;

template <class T>
void append_one(Hdf5File& file, const std::string& name, T value) {
  file.append_rows(name, &value, 1);
}

// Large enough to be written at the disk's speed, small enough not to bloat the file of a small run.
std::int64_t points_per_chunk(std::int64_t points) { return std::clamp<std::int64_t>(points, 128, 65536); }

void create_field(Hdf5File& file, const PointField& field, std::int64_t chunk) {
  const auto create = [&]<class T>(const T*) {
    file.create_rows<T>(kPointData + field.name, field.width, chunk, field.label);
  };
  std::visit(create, field.values);
}

void append_field(Hdf5File& file, const PointField& field, std::int64_t points) {
  const auto append = [&](const auto* values) { file.append_rows(kPointData + field.name, values, points); };
  std::visit(append, field.values);
}

void create_steps(Hdf5File& file) {
  const auto create = [&]<class T>(T, const std::string& name, int width, const std::string& unit,
                                   const std::string& description) {
    file.create_rows<T>(kSteps + name, width, kStepsPerChunk, {unit, description});
  };
  create(Real{}, "Values", 1, "s", "time of each snapshot");
  create(std::int64_t{}, "PartOffsets", 1, "1", "part that holds the vertices of each snapshot");
  create(std::int64_t{}, "NumberOfParts", 1, "1", "parts of each snapshot");
  create(std::int64_t{}, "PointOffsets", 1, "1", "first row of each snapshot in Points and in every field");
  create(std::int64_t{}, "CellOffsets", 4, "1",
         "first cell of each snapshot: vertices, lines, polygons, strips");
  // A vertex has one connectivity id, so these are the same numbers.
  file.link(kSteps + "CellOffsets", kSteps + "ConnectivityIdOffsets");
  file.write_integer_attribute(kSteps, "NSteps", {0});
}

void create_topology(Hdf5File& file, std::int64_t chunk) {
  const auto create = [&](const std::string& name, std::int64_t chunk_rows, const std::string& description) {
    file.create_rows<std::int64_t>(kRoot + name, 1, chunk_rows, {"1", description});
  };
  create("NumberOfPoints", kStepsPerChunk, "points of each part");
  create("Vertices/Connectivity", chunk, "point of each vertex, counted from the part's first");
  create("Vertices/Offsets", chunk,
         "first connectivity id of each vertex, and their number: one more row per part");
  file.link(kRoot + "NumberOfPoints", kRoot + "Vertices/NumberOfCells");
  file.link(kRoot + "NumberOfPoints", kRoot + "Vertices/NumberOfConnectivityIds");
  create("Lines/NumberOfCells", kStepsPerChunk, "cells of each part: none");
  create("Lines/Offsets", kStepsPerChunk, "one 0 per part");
  create("Lines/Connectivity", kStepsPerChunk, "empty");
  file.link(kRoot + "Lines/NumberOfCells", kRoot + "Lines/NumberOfConnectivityIds");
  file.link(kRoot + "Lines", kRoot + "Polygons");
  file.link(kRoot + "Lines", kRoot + "Strips");
}

void append_part(Hdf5File& file, std::int64_t points) {
  std::vector<std::int64_t> count(static_cast<std::size_t>(points) + 1);
  std::iota(count.begin(), count.end(), 0);
  append_one(file, kRoot + "NumberOfPoints", points);
  file.append_rows(kRoot + "Vertices/Connectivity", count.data(), points);
  file.append_rows(kRoot + "Vertices/Offsets", count.data(), points + 1);
  append_one(file, kRoot + "Lines/NumberOfCells", std::int64_t{0});
  append_one(file, kRoot + "Lines/Offsets", std::int64_t{0});
}

}  // namespace

VtkHdfSeries::VtkHdfSeries(const std::string& directory, const std::string& name, const std::string& title,
                           int keep)
    : name_(name),
      title_(title),
      xdmf_path_(directory + "/" + name + ".xdmf"),
      file_(directory + "/" + name + ".vtkhdf") {
  if (keep == 0 || !file_.exists()) {
    file_.remove();
    remove_xdmf();
    return;
  }
  read_places();
  if (snapshots() < keep) {
    throw IoError(fmt::format("{}: holds {} snapshots, but the restarted run has written {}", path(),
                              snapshots(), keep));
  }
  if (snapshots() > keep) cut(static_cast<std::size_t>(keep));
}

void VtkHdfSeries::read_places() {
  const Hdf5File file(path(), Hdf5Access::read);
  const auto time = file.read_array<Real>(kSteps + "Values");
  const auto part = file.read_array<std::int64_t>(kSteps + "PartOffsets");
  const auto first_point = file.read_array<std::int64_t>(kSteps + "PointOffsets");
  const auto first_cell = file.read_array<std::int64_t>(kSteps + "CellOffsets");
  const auto points = file.read_array<std::int64_t>(kRoot + "NumberOfPoints");
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
    places_[s] = {time[s], points[static_cast<std::size_t>(part[s])], first_point[s], part[s],
                  first_cell[4 * s]};
  }
}

void VtkHdfSeries::cut(std::size_t keep) {
  remove_xdmf();  // it would refer to rows that are gone; the next append writes it
  places_.resize(keep);
  const SnapshotPlace last = places_.back();
  const std::int64_t steps = static_cast<std::int64_t>(keep), parts = last.part + 1;
  const std::int64_t cells = last.first_cell + last.points;
  file_.update([&](Hdf5File& file) {
    file.write_integer_attribute(kSteps, "NSteps", {steps});
    for (const char* name : {"Values", "PartOffsets", "NumberOfParts", "PointOffsets", "CellOffsets"}) {
      file.resize_rows(kSteps + name, steps);
    }
    for (const char* name : {"NumberOfPoints", "Lines/NumberOfCells", "Lines/Offsets"}) {
      file.resize_rows(kRoot + name, parts);
    }
    file.resize_rows(kRoot + "Vertices/Connectivity", cells);
    file.resize_rows(kRoot + "Vertices/Offsets", cells + parts);
    file.resize_rows(kRoot + "Points", last.first_point + last.points);
    for (const std::string& name : file.dataset_names(kPointData)) {
      file.resize_rows(kPointData + name, last.first_point + last.points);
    }
  });
}

void VtkHdfSeries::lay_out(Hdf5File& file, const PointSnapshot& first) const {
  const std::int64_t chunk = points_per_chunk(first.points);
  file.create_group(kSteps);
  file.write_integer_attribute("/VTKHDF", "Version", {2, 0});
  file.write_text_attribute("/VTKHDF", "Type", "PolyData");
  create_steps(file);
  create_topology(file, chunk);
  file.create_rows<Real>(kRoot + "Points", 3, chunk, {"m", "position"});
  for (const PointField& field : first.fields) {
    create_field(file, field, chunk);
    // Every field has as many rows as Points, so it begins where they begin.
    file.link(kSteps + "PointOffsets", kSteps + "PointDataOffsets/" + field.name);
  }
  file.create_group("/Scree");
  file.write_text_attribute("/Scree", "title", title_);
  file.write_text_attribute("/Scree", "version", version());
  file.write_text_attribute("/Scree", "commit", commit());
}

SnapshotPlace VtkHdfSeries::next_place(const PointSnapshot& snapshot) const {
  SnapshotPlace place{snapshot.time, snapshot.points, 0, 0, 0};
  if (places_.empty()) return place;
  const SnapshotPlace& last = places_.back();
  place.first_point = last.first_point + last.points;
  const bool same_part = last.points == snapshot.points;
  place.part = same_part ? last.part : last.part + 1;
  place.first_cell = same_part ? last.first_cell : last.first_cell + last.points;
  return place;
}

void VtkHdfSeries::write(Hdf5File& file, const PointSnapshot& snapshot, const SnapshotPlace& place) const {
  if (places_.empty()) lay_out(file, snapshot);
  if (places_.empty() || place.part != places_.back().part) append_part(file, snapshot.points);
  file.append_rows(kRoot + "Points", snapshot.position, snapshot.points);
  for (const PointField& field : snapshot.fields) append_field(file, field, snapshot.points);
  append_one(file, kSteps + "Values", snapshot.time);
  append_one(file, kSteps + "PartOffsets", place.part);
  append_one(file, kSteps + "NumberOfParts", std::int64_t{1});
  append_one(file, kSteps + "PointOffsets", place.first_point);
  const std::int64_t first_cell[4] = {place.first_cell, 0, 0, 0};
  file.append_rows(kSteps + "CellOffsets", first_cell, 1);
  file.write_integer_attribute(kSteps, "NSteps", {static_cast<std::int64_t>(places_.size()) + 1});
}

void VtkHdfSeries::append(const PointSnapshot& snapshot) {
  const SnapshotPlace place = next_place(snapshot);
  file_.update([&](Hdf5File& file) { write(file, snapshot, place); });
  places_.push_back(place);
  write_xdmf(snapshot);
}

void VtkHdfSeries::remove_xdmf() const {
  std::error_code none_there;
  std::filesystem::remove(xdmf_path_, none_there);
}

void VtkHdfSeries::write_xdmf(const PointSnapshot& snapshot) {
  const XdmfSeries series{name_, title_, name_ + ".vtkhdf", &snapshot.fields};
  for (; xdmf_snapshots_ < places_.size(); ++xdmf_snapshots_) {
    xdmf_grids_ += xdmf_grid(series, places_[xdmf_snapshots_]);
  }
  write_text_file(xdmf_path_, xdmf_document(series, xdmf_grids_));
}

}  // namespace scree
