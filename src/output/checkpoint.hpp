// Checkpoint: the whole state as named arrays in one HDF5 file, sealed with a checksum (file_seal.hpp),
// written beside and renamed.
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

// An array of rows that are spread over the ranks, consecutive ones on each, in the order of the ranks. They
// are made or read piece by piece.
template <class T>
struct CheckpointRows {
  int width = 1;           // values per row
  std::int64_t count = 0;  // rows of this rank
  // Values of rows [first, first + count) of this rank: [count][width]. Where it was read from a file, those
  // of other ranks can be had, too: below 0 and past `count`.
  std::function<void(std::int64_t first, std::int64_t count, T* to)> copy;
  std::string unit = {}, description = {};  // for readers of the file; not read back
};

// What the step loop packs and unpacks; this room gives no meaning to it. Values return bit for bit. Names
// may hold '/' for groups.
struct Checkpoint {
  // The same on every rank when read; rank 0's are written.
  std::map<std::string, std::vector<Real>> reals;
  std::map<std::string, std::vector<std::int64_t>> integers;
  std::map<std::string, std::string> texts;  // the deck's fingerprint, version, commit
  std::map<std::string, CheckpointRows<Real>> real_rows;
  std::map<std::string, CheckpointRows<std::int64_t>> integer_rows;

  // Throw IoError naming the file and what is missing.
  const std::vector<Real>& real_array(const std::string& name) const;
  const std::vector<std::int64_t>& integer_array(const std::string& name) const;
  template <class T>
  const CheckpointRows<T>& row_array(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  std::string path;  // where it was read from, for messages

  // The rows of one type: real_rows or integer_rows.
  template <class T>
  std::map<std::string, CheckpointRows<T>>& rows() {
    if constexpr (std::is_same_v<T, Real>)
      return real_rows;
    else
      return integer_rows;
  }
};

// Writes PATH.tmp, syncs it to disk and renames it to PATH. Throws IoError; PATH is then what it was before.
// compression: 0, or deflate's level, of the rows. Collective.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint, const Ranks& ranks = {},
                      int compression = 0);
// How large the file gets without compression [B]. rows: of each array of real_rows and integer_rows, those
// of all ranks; its own count where it is not named.
Real checkpoint_size(const Checkpoint& checkpoint, const std::map<std::string, std::int64_t>& rows);
// Every rank reads what is the same on all of them, and has an equal part of the rows (id_range), which their
// `copy` reads from the file. Throws IoError, on every rank, on a missing, truncated, damaged or foreign
// file. Collective.
Checkpoint read_checkpoint(const std::string& path, const Ranks& ranks = {});

}  // namespace scree
