// Rows of one HDF5 file that are distributed over the ranks in consecutive blocks. No rank holds rows of all
// others: all ranks write at once with a parallel library, otherwise rank 0 writes. The files are identical.
//
// A full disk is always detected, although an MPI library may report a truncated write as complete: for
// collective writes the disk space of the rows is reserved before. If that is impossible (compressed rows, or
// a file system that cannot reserve), the rows are read back.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "output/hdf5_file.hpp"
#include "output/hdf5_parts.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Whether this build writes collectively; otherwise rank 0 writes for all ranks.
extern const bool kParallelHdf5;

// A rank's part of the rows written or read: rows [first, first + count) of the dataset.
struct RowPart {
  std::int64_t first = 0, count = 0;
};

// All functions are collective, and throw IoError on every rank if one rank fails.
class SharedRows {
 public:
  // Opens an existing file, which the owner has closed after adding space for the rows
  // (Hdf5File::resize_rows). collective: for tests only; false also works with a parallel library.
  SharedRows(const Ranks& ranks, const std::string& path, bool collective = kParallelHdf5);
  // Writes through rank 0, which has opened the file and closes it; null on other ranks. Serial writes of the
  // library report a full disk themselves.
  SharedRows(const Ranks& ranks, Hdf5File* open);
  ~SharedRows();
  SharedRows(const SharedRows&) = delete;
  SharedRows& operator=(const SharedRows&) = delete;
  // Passes all data to the operating system, and reads rows back that had no reserved space.
  void close();

  // Writes this rank's part from memory: [part.count][width].
  template <class T>
  void write(const std::string& name, int width, RowPart part, const T* values) {
    write(name, {hdf5_type<T>(), width}, part,
          [=](std::int64_t first, std::int64_t) { return values + first * width; });
  }
  // Writes this rank's part piece by piece: piece(first, count) returns rows [first, first + count) of the
  // part, valid until the next call.
  template <class T>
  void write_pieces(const std::string& name, int width, RowPart part,
                    const std::function<const T*(std::int64_t first, std::int64_t count)>& piece) {
    write(name, {hdf5_type<T>(), width}, part, piece);
  }

 private:
  struct RowType {
    hid_t value;
    int width;
    std::size_t bytes() const { return as_size(width) * H5Tget_size(value); }
  };
  using Piece = std::function<const void*(std::int64_t first, std::int64_t count)>;
  void write(const std::string& name, RowType type, RowPart part, const Piece& piece);
  void write_collectively(const std::string& name, RowType type, RowPart part, const Piece& piece);
  void write_through_root(const std::string& name, RowType type, RowPart part, const Piece& piece);
  void put(const std::string& name, RowType type, RowPart rows, const void* values);
  void read_back();
  bool has_file() const { return collective_ || ranks_.is_root(); }
  [[noreturn]] void fail(const std::string& action) const;

  // Rows of this rank written without reserved space.
  struct Written {
    std::string name;
    RowType type;
    RowPart rows;
    std::uint64_t hash;
  };

  Ranks ranks_;
  std::string path_;
  bool collective_;
  bool reads_back_ = true;
  std::vector<Written> written_;
  hid_t file_ = H5I_INVALID_HID;
  bool owns_file_ = true;
  Hdf5Id transfer_;
};

}  // namespace scree
