// How large an HDF5 file gets, before it is written: what Hdf5File puts into it, added up by the library's
// file format (The HDF Group, "HDF5 File Format Specification 2.0": object headers, groups of version 0,
// B-trees of version 1).
#pragma once

#include <cstdint>

#include "base/types.hpp"
#include "output/hdf5_file.hpp"

namespace scree {

class Hdf5Size {
 public:
  // likely_chunks: as Hdf5File's.
  explicit Hdf5Size(std::int64_t likely_chunks = 0) : likely_chunks_(likely_chunks) {}

  // A dataset with a label, of so many rows of `value_bytes` times the width.
  void add_rows(const RowStorage& storage, std::int64_t value_bytes, std::int64_t rows);
  // A dataset without a label, of so many bytes.
  void add_array(std::int64_t bytes);
  // With so many names in it.
  void add_group(std::int64_t names);
  Real bytes() const { return bytes_; }

 private:
  std::int64_t likely_chunks_;
  Real bytes_ = 2048;  // superblock, root group, what is left over
};

}  // namespace scree
