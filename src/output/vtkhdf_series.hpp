// A time series of point sets, lines or triangles in one VTKHDF file, and an .xdmf that refers to the same
// data.
//
// VTKHDF 2.0, type PolyData: docs.vtk.org, "VTKHDF format specification". All snapshots' rows follow each
// other in each dataset; the group Steps says where those of one snapshot begin. Vertices, one cell per
// point, or lines, one per two points, of a snapshot are one part; it is shared by the snapshots that follow
// with the same number of points, and so are the fields that never change of a point, as points only ever
// leave. Triangles between points that move are one part for all snapshots.
//
// The .xdmf names every snapshot in one text, which ends in closing tags: it is complete only as a whole. It
// is written beside and renamed, not at each snapshot, but when there are a fifth more than it knows (and at
// each of the first five), and by finish(): all its writing together is six times its last size at most.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "output/series_cells.hpp"
#include "output/series_names.hpp"
#include "output/series_triangles.hpp"
#include "output/twin_file.hpp"

namespace scree {

// One field of this rank's points or lines, or of the triangles, of one snapshot: values[point][width], width
// 1, 3, or 9 for a tensor, row by row.
struct PointField {
  std::string name;
  DatasetLabel label;
  int width = 1;
  std::variant<const Real*, const int*, const GlobalId*> values;
};

static_assert(sizeof(Vec3) == 3 * sizeof(Real), "a Vec3 array is written as a [n][3] dataset");
inline const Real* components(std::span<const Vec3> values) {
  return reinterpret_cast<const Real*>(values.data());
}

// Of values that last: a number each, or a vector.
template <class Values>
PointField field_of(const char* name, const DatasetLabel& label, const Values& values) {
  if constexpr (std::is_convertible_v<const Values&, std::span<const Vec3>>)
    return {name, label, 3, components(values)};
  else
    return {name, label, 1, values.data()};
}

struct PointSnapshot {
  Real time = 0;                   // [s]
  std::int64_t points = 0;         // of all ranks; may differ from snapshot to snapshot, and be 0
  RowPart own;                     // of these, this rank's
  const Real* position = nullptr;  // [own.count][3] [m]
  // The same names and widths in every snapshot: of the points or, where the series shows lines or triangles,
  // of these.
  std::vector<PointField> fields;
};

// Where one snapshot lies in the file; all counted in rows.
struct SnapshotPlace {
  Real time = 0;                             // [s]
  std::int64_t points = 0, first_point = 0;  // in Points and in every field
  std::int64_t part = 0, first_cell = 0;     // in NumberOfPoints; of the vertices or lines
  std::int64_t number = 0;                   // of the snapshot, from 0
};

struct SeriesOptions {
  std::string title;
  int keep = 0;         // snapshots to keep
  int compression = 0;  // of new files, RowStorage::compression
  Ranks ranks = {};     // that have the points; the constructor and append() are collective
  // Those of the snapshots to come, where files that are continued are to be looked at for them.
  std::optional<std::vector<std::string>> fields = {};
  std::vector<SeriesNames> names = {};            // of a new file; those without entries are left out
  std::optional<SeriesTriangles> triangles = {};  // of a series of triangles, which one rank writes
  bool lines = false;                             // between each two points; every rank has whole ones
  std::int64_t likely_points = 0;                 // of a snapshot, where the first one may have few
  std::int64_t likely_snapshots = 0;              // at the end, which sizes a new file; 0: not known, many
  std::vector<std::string> constant = {};         // fields of points that never change of a point
};

// Rows of the datasets' chunks in a new file: of what there is once for each snapshot, and of what there is
// for each of so many points, lines or triangles of every snapshot. Large enough to be written at the disk's
// speed, small enough not to bloat the file of a small run.
std::int64_t steps_per_chunk(const SeriesOptions& options);
std::int64_t points_per_chunk(std::int64_t points, const SeriesOptions& options);

class VtkHdfSeries {
 public:
  // Continues DIRECTORY/NAME.vtkhdf where there is one and keep > 0, cutting off all but its first `keep`
  // snapshots; otherwise starts anew. Throws IoError where the file has fewer, other fields or triangles.
  VtkHdfSeries(const std::string& directory, const std::string& name, const SeriesOptions& options);

  // Adds a snapshot, in parts for series that grow together (TwinFile): all prepare() it, then all show() it,
  // then rank 0 syncs the folder, then all follow(), which rewrites the .xdmf where it is time to. Throw
  // IoError; before a show() the files then hold what they held.
  void prepare(const PointSnapshot& snapshot);
  void show();
  void follow(const PointSnapshot& snapshot);
  // Brings the .xdmf up to date. Throws IoError.
  void finish();
  int snapshots() const { return static_cast<int>(places_.size()); }
  const std::string& path() const { return file_.path(); }

 private:
  void read_places();
  void require_constant_offsets(const Hdf5File& file) const;
  void require_fields() const;
  bool has_cell_fields() const { return options_.triangles || options_.lines; }
  const SeriesCells& cells() const { return options_.lines ? kLines : kVertices; }  // without triangles
  void require_fields_of(const Hdf5File& file, const PointSnapshot& snapshot) const;
  const std::string& field_group() const;
  std::string field_offsets() const;
  // Of a field; own: points.
  RowPart field_rows(const SnapshotPlace& place, RowPart own, const std::string& field) const;
  bool is_constant(const std::string& field) const;
  bool adds_rows(const SnapshotPlace& place, const std::string& field) const;
  void cut(std::size_t keep);
  void lay_out(Hdf5File& file, const PointSnapshot& first) const;
  void lay_out_fields(Hdf5File& file, const PointSnapshot& first, RowStorage storage) const;
  SnapshotPlace next_place(const PointSnapshot& snapshot) const;
  bool starts_part(const SnapshotPlace& place) const;
  void cut_points(Hdf5File& file) const;
  void append_cell_offsets(Hdf5File& file, std::int64_t first_cell) const;
  void make_room(Hdf5File& file, const PointSnapshot& snapshot, const SnapshotPlace& place) const;
  void write_rows(SharedRows& file, const PointSnapshot& snapshot, const SnapshotPlace& place) const;
  TwinFile::Change change(const PointSnapshot& snapshot) const;
  void remove_xdmf() const;
  void add_xdmf(const PointSnapshot& snapshot);
  void write_xdmf();

  std::string name_, xdmf_path_;
  SeriesOptions options_;
  TwinFile file_;
  std::vector<SnapshotPlace> places_;
  std::string xdmf_grids_;  // of the first xdmf_snapshots_ snapshots, of which the file has xdmf_written_
  std::size_t xdmf_snapshots_ = 0, xdmf_written_ = 0;
};

}  // namespace scree
