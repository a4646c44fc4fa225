// History: scalar time series in HDF5 (and, on request, CSV).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

// One scalar time series. group/name is the dataset's path in the file, e.g. "energy" / "kinetic".
struct HistoryColumn {
  std::string group, name, unit, description;
};

// Writes DIRECTORY/history.h5 (one extensible dataset per column, attributes unit and description) and
// history.csv. Rows are buffered and written by flush(), which leaves the file complete and closed.
class HistoryWriter {
 public:
  // keep: number of rows to keep when a restarted run continues an existing file (later ones are cut off).
  HistoryWriter(const std::string& directory, std::vector<HistoryColumn> columns, bool csv, std::int64_t keep);
  // One value per column.
  void append(const std::vector<Real>& row);
  void flush();  // throws IoError
  std::int64_t rows() const { return rows_; }

 private:
  std::string directory_;
  std::vector<HistoryColumn> columns_;
  std::vector<std::vector<Real>> buffer_;  // [row][column]
  bool csv_ = false;
  std::int64_t rows_ = 0;  // appended in all, kept ones included
};

}  // namespace scree
