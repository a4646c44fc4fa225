// A time series of point sets, lines or triangles in one VTKHDF file, with an .xdmf that refers to the same
// data.
//
// VTKHDF 2.0, type PolyData: docs.vtk.org, "VTKHDF format specification". In each dataset the rows of all
// snapshots follow each other; the group Steps contains the first row of each snapshot. The vertices of a
// snapshot, one cell per point, or its lines, one per two points, form one part. Following snapshots with the
// same number of points share the part, together with the constant fields of points, because points are
// removed but never added. Triangles between moving points are one part for all snapshots.
//
// The .xdmf lists every snapshot in one text with closing tags at the end, so that it must be written as a
// whole. It is written under another name and renamed, not at each snapshot but when the number of snapshots
// has grown by a fifth (and at each of the first five), and by finish(): in total at most six times its final
// size is written.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/index.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "output/double_buffered_file.hpp"
#include "output/series_cells.hpp"
#include "output/series_names.hpp"
#include "output/series_triangles.hpp"

namespace scree {

// One field of this rank's points or lines, or of the triangles, of one snapshot: values[point][width], with
// width 1, 3, or 9 for a tensor by rows.
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

// A field of scalars or vectors, which must outlive it.
template <class Values>
PointField field_of(const char* name, const DatasetLabel& label, const Values& values) {
  if constexpr (std::is_convertible_v<const Values&, std::span<const Vec3>>)
    return {name, label, 3, components(values)};
  else
    return {name, label, 1, values.data()};
}

struct PointSnapshot {
  Real time = 0;                   // [s]
  std::int64_t points = 0;         // over all ranks; may change from snapshot to snapshot and be 0
  RowPart own;                     // this rank's part of the points
  const Real* position = nullptr;  // [own.count][3] [m]
  // Equal names and widths in every snapshot; fields of the points, or of the lines or triangles of the
  // series.
  std::vector<PointField> fields;
};

// Position of one snapshot in the file; all in rows.
struct SnapshotRows {
  Real time = 0;                             // [s]
  std::int64_t points = 0, first_point = 0;  // in Points and in the fields of points
  std::int64_t part = 0, first_cell = 0;     // in NumberOfPoints; among the vertices or lines
  std::int64_t number = 0;                   // of the snapshot, from 0
};

struct SeriesOptions {
  std::string title;
  int keep = 0;         // number of existing snapshots to keep
  int compression = 0;  // of new files, RowStorage::compression
  Ranks ranks = {};     // the ranks with the points; the constructor and append() are collective
  // Names of the fields of further snapshots, to be checked against files that are continued.
  std::optional<std::vector<std::string>> fields = {};
  std::vector<SeriesNames> names = {};            // of a new file; lists without entries are left out
  std::optional<SeriesTriangles> triangles = {};  // for a series of triangles, which one rank writes
  bool lines = false;                             // a line between every two points, which are on one rank
  std::int64_t likely_points = 0;                 // per snapshot, as the first one may have few
  std::int64_t likely_snapshots = 0;              // expected in total, sizes a new file; 0: not known, many
  std::vector<std::string> constant = {};         // fields whose value never changes for a point
};

// Rows per chunk of the datasets in a new file: datasets with one row per snapshot, and datasets with one row
// per point, line or triangle of every snapshot (`points` of them). The chunks are large enough for the full
// speed of the disk and small enough for small runs.
std::int64_t steps_per_chunk(const SeriesOptions& options);
std::int64_t points_per_chunk(std::int64_t points, const SeriesOptions& options);

class VtkHdfSeries {
 public:
  // Continues DIRECTORY/NAME.vtkhdf, if it exists and keep > 0, after removing all but its first `keep`
  // snapshots; otherwise starts a new file. Throws IoError if the file has fewer snapshots, or other fields
  // or triangles.
  VtkHdfSeries(const std::string& directory, const std::string& name, const SeriesOptions& options);

  // Adds a snapshot in parts, for series that grow together (DoubleBufferedFile): prepare() of all, then
  // show() of all, then rank 0 syncs the folder, then follow() of all, which also rewrites the .xdmf when
  // due. Throw IoError; before show() the files are unchanged.
  void prepare(const PointSnapshot& snapshot);
  void show();
  void follow(const PointSnapshot& snapshot);
  // Updates the .xdmf. Throws IoError.
  void finish();
  int snapshots() const { return as_index(places_.size()); }
  const std::string& path() const { return file_.path(); }

 private:
  void read_snapshot_rows();
  void require_constant_offsets(const Hdf5File& file) const;
  void require_fields() const;
  bool has_cell_fields() const { return options_.triangles || options_.lines; }
  const SeriesCells& cells() const {
    return options_.lines ? kLines : kVertices;
  }  // for series without triangles
  void require_fields_of(const Hdf5File& file, const PointSnapshot& snapshot) const;
  const std::string& field_group() const;
  std::string field_offsets() const;
  // Rows of a field; own: this rank's points.
  RowPart field_rows(const SnapshotRows& place, RowPart own, const std::string& field) const;
  bool is_constant(const std::string& field) const;
  bool adds_rows(const SnapshotRows& place, const std::string& field) const;
  void cut(std::size_t keep);
  void lay_out(Hdf5File& file, const PointSnapshot& first) const;
  void lay_out_fields(Hdf5File& file, const PointSnapshot& first, RowStorage storage) const;
  SnapshotRows next_rows(const PointSnapshot& snapshot) const;
  bool starts_part(const SnapshotRows& place) const;
  void cut_points(Hdf5File& file) const;
  void append_cell_offsets(Hdf5File& file, std::int64_t first_cell) const;
  void reserve_entries(Hdf5File& file, const PointSnapshot& snapshot, const SnapshotRows& place) const;
  void write_rows(SharedRows& file, const PointSnapshot& snapshot, const SnapshotRows& place) const;
  DoubleBufferedFile::Change change(const PointSnapshot& snapshot) const;
  void remove_xdmf() const;
  void add_xdmf(const PointSnapshot& snapshot);
  void write_xdmf();

  std::string name_, xdmf_path_;
  SeriesOptions options_;
  DoubleBufferedFile file_;
  std::vector<SnapshotRows> places_;
  // Grids of the first xdmf_snapshots_ snapshots; the file has xdmf_written_ of them.
  std::string xdmf_grids_;
  std::size_t xdmf_snapshots_ = 0, xdmf_written_ = 0;
};

}  // namespace scree
