// Size of an HDF5 file before it is written: the sum over the objects that Hdf5File creates, according to the
// file format (The HDF Group, "HDF5 File Format Specification 2.0": object headers, groups of version 0,
// B-trees of version 1).
#pragma once

#include <cstdint>

#include "base/types.hpp"
#include "output/hdf5_file.hpp"

namespace scree {

class Hdf5Size {
 public:
  // likely_chunks: as for Hdf5File.
  explicit Hdf5Size(std::int64_t likely_chunks = 0) : likely_chunks_(likely_chunks) {}

  // Adds a dataset with a label and `rows` rows of width values of `value_bytes` bytes each.
  void add_rows(const RowStorage& storage, std::int64_t value_bytes, std::int64_t rows);
  // Adds a dataset without a label, of so many bytes.
  void add_array(std::int64_t bytes);
  // Adds a group with so many names.
  void add_group(std::int64_t names);
  Real bytes() const { return bytes_; }

 private:
  std::int64_t likely_chunks_;
  Real bytes_ = 2048;  // superblock, root group, unused space
};

}  // namespace scree
