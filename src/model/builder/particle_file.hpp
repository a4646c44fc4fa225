// Particles from a CSV or HDF5 file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "model/data/id_range.hpp"

namespace scree {

// Columns by name, of equal length: x, y [m] and, in 3D, z; optional vx, vy, vz [m/s], wx, wy, wz [rad/s] (in
// 2D wz alone), radius [m], mass [kg], inertia_factor. vx and vy (and vz in 3D) come together, and so do wx,
// wy and wz.
using ParticleColumns = std::map<std::string, std::vector<Real>>;

// CSV: a header line with the columns' names, then one line per particle, separated by commas. Cells may be
// quoted; blanks around cells, empty lines and lines that begin with # are skipped. HDF5 (by its contents, or
// names that end in .h5 or .hdf5): one dataset of numbers per column. Throws InputError with file, line,
// column and value for invalid contents; IoError where the file cannot be read. A CSV is read as a whole for
// any range of rows, an HDF5 file is not.
class ParticleFile {
 public:
  ParticleFile(const std::string& path, int dimension);
  std::int64_t count() const { return count_; }
  bool has(const std::string& column) const;
  ParticleColumns read(IdRange rows) const;

 private:
  std::string path_;
  bool hdf5_;
  std::vector<std::string> columns_;
  std::int64_t count_ = 0;
};

}  // namespace scree
