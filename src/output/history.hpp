// History: scalar time series in HDF5 (and, on request, CSV).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "output/double_buffered_file.hpp"

namespace scree {

// One scalar time series. group/name is the path of the dataset in the file, e.g. "energy" / "kinetic"; the
// group may be empty.
struct HistoryColumn {
  std::string group, name, unit, description;
};

// Writes DIRECTORY/history.h5 (one extensible dataset per column, with attributes unit and description) and
// optionally history.csv with a header "time [s],energy/kinetic [J],...". Rows are buffered until flush(),
// which leaves complete, closed and synced files. history.h5 is readable at any time, even after a kill
// during a write; history.csv may then end with an incomplete line.
class HistoryWriter {
 public:
  // keep: number of rows to keep when a restarted run continues an existing file (later ones are cut off); 0
  // starts new files and removes old ones. Throws IoError where the file holds fewer rows or other columns;
  // columns under the names of earlier versions get the present names.
  // likely_rows: at the end, which sizes a new file; 0: not known, many.
  HistoryWriter(const std::string& directory, std::vector<HistoryColumn> columns, bool csv, std::int64_t keep,
                std::int64_t likely_rows = 0);
  // Appends one value per column. Throws SimulationError for another number of values.
  void append(const std::vector<Real>& row);
  void flush();  // throws IoError, with the rows still buffered
  std::int64_t rows() const { return rows_; }

 private:
  void cut(std::int64_t keep);
  void require_columns(std::vector<std::string> names) const;
  void write_rows(Hdf5File& file, std::int64_t rows_before) const;
  void rewrite_csv() const;

  std::vector<HistoryColumn> columns_;
  std::int64_t chunk_rows_;
  DoubleBufferedFile file_;
  std::string csv_path_;                   // empty where no CSV is wanted
  std::vector<std::vector<Real>> buffer_;  // [column][row]
  std::int64_t rows_ = 0;                  // all rows, including those kept
};

// Sizes of the two files with so many rows [B]. likely_rows: as for the writer.
struct HistorySize {
  Real hdf5 = 0, csv = 0;
};
HistorySize history_size(const std::vector<HistoryColumn>& columns, std::int64_t rows,
                         std::int64_t likely_rows);

}  // namespace scree
