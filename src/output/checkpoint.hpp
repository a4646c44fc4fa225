// Checkpoint: the complete state as named arrays in one HDF5 file, which ends with a checksum
// (file_seal.hpp). It is written under another name and then renamed.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "base/types.hpp"
#include "partition/ranks.hpp"

namespace scree {

// An array whose rows are distributed over the ranks in order, consecutive rows on each. The rows are
// produced or read in pieces.
template <class T>
struct CheckpointRows {
  int width = 1;           // values per row
  std::int64_t count = 0;  // rows of this rank
  // Copies the values [count][width] of rows [first, first + count) of this rank. For rows read from a file,
  // those of other ranks are available, too: below 0 and from `count` on.
  std::function<void(std::int64_t first, std::int64_t count, T* to)> copy;
  std::string unit = {}, description = {};  // for users of the file; not read back
};

// The data that the step loop packs and unpacks; this code is independent of their meaning. Values are
// restored bit for bit. Names may contain '/' for groups.
struct Checkpoint {
  // Equal on every rank when read; rank 0's values are written.
  std::map<std::string, std::vector<Real>> reals;
  std::map<std::string, std::vector<std::int64_t>> integers;
  std::map<std::string, std::string> texts;  // the deck's fingerprint, version, commit
  std::map<std::string, CheckpointRows<Real>> real_rows;
  std::map<std::string, CheckpointRows<std::int64_t>> integer_rows;

  // Access by name; throw IoError with the file and the missing name.
  const std::vector<Real>& real_array(const std::string& name) const;
  const std::vector<std::int64_t>& integer_array(const std::string& name) const;
  template <class T>
  const CheckpointRows<T>& row_array(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  std::string path;  // file that it was read from, for messages

  // The rows with values of type T: real_rows or integer_rows.
  template <class T>
  std::map<std::string, CheckpointRows<T>>& rows() {
    if constexpr (std::is_same_v<T, Real>)
      return real_rows;
    else
      return integer_rows;
  }
};

// Writes PATH.tmp, syncs it to disk and renames it to PATH. Throws IoError, with PATH unchanged. compression:
// of the rows, 0 or a level of deflate. Collective.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint, const Ranks& ranks = {},
                      int compression = 0);
// Size of the file without compression [B]. rows: total number of rows over all ranks, for arrays of
// real_rows and integer_rows; by default the array's own count.
Real checkpoint_size(const Checkpoint& checkpoint, const std::map<std::string, std::int64_t>& rows);
// Reads a checkpoint: every rank gets the values, and an equal part of the rows (id_range), which their
// `copy` reads from the file. Throws IoError, on every rank, if the file is missing, truncated, damaged or
// foreign. Collective.
Checkpoint read_checkpoint(const std::string& path, const Ranks& ranks = {});

}  // namespace scree
