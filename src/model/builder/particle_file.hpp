// Particles from a CSV or HDF5 file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "model/data/id_range.hpp"

namespace scree {

// Columns by name, all of one length: x, y [m] and, in 3D, z always; vx, vy, vz [m/s], wx, wy, wz [rad/s] (in
// 2D wz alone), radius [m], mass [kg], inertia_factor where the file has them. vx and vy (and vz in 3D) come
// together, and so do wx, wy and wz.
using ParticleColumns = std::map<std::string, std::vector<Real>>;

// CSV: a header line with the columns' names, then one line per particle; commas between, cells may stand in
// quotes, blanks around them, empty lines and lines that start with # are skipped. HDF5 (by its contents, or
// names that end in .h5 or .hdf5): one dataset of numbers per column. Throws InputError naming file, line,
// column and value on contents that are no such table; IoError where the file cannot be read. A CSV is looked
// through as a whole whichever rows are wanted, HDF5 is not.
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

// All of a file.
ParticleColumns read_particle_file(const std::string& path, int dimension);

}  // namespace scree
