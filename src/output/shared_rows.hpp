// Rows of one HDF5 file that are spread over the ranks: consecutive rows of each rank, written without any
// rank holding those of others, by all ranks at once where the library is a parallel one, else through rank
// 0. The files are the same.
//
// A full disk does not pass unseen, though an MPI library may take a write that was cut short for a whole
// one: where all ranks write, the rows' disk space is reserved before. Where that cannot be, because they
// are compressed or the file system does not reserve, they are read back.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "output/hdf5_file.hpp"
#include "output/hdf5_parts.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Whether this build writes collectively; else rank 0 writes for all.
extern const bool kParallelHdf5;

// A rank's part of rows that are written or read: rows [first, first + count) of the dataset.
struct RowPart {
  std::int64_t first = 0, count = 0;
};

// All functions are collective, and throw IoError on every rank where one rank fails.
class SharedRows {
 public:
  // Opens an existing file. It has been closed by whoever made room for the rows (Hdf5File::resize_rows).
  // collective: only for tests; false works with a parallel library, too.
  SharedRows(const Ranks& ranks, const std::string& path, bool collective = kParallelHdf5);
  // Through rank 0, which has the file open and closes it; elsewhere there is none. What the library writes
  // for one process tells of a full disk itself.
  SharedRows(const Ranks& ranks, Hdf5File* open);
  ~SharedRows();
  SharedRows(const SharedRows&) = delete;
  SharedRows& operator=(const SharedRows&) = delete;
  // Hands everything to the operating system, and reads it back where it had no reserved space.
  void close();

  // This rank's part, of values in memory: [part.count][width].
  template <class T>
  void write(const std::string& name, int width, RowPart part, const T* values) {
    write(name, {hdf5_type<T>(), width}, part,
          [=](std::int64_t first, std::int64_t) { return values + first * width; });
  }
  // The same, made piece by piece: piece(first, count) returns rows [first, first + count) of this part,
  // which stay until it is called again.
  template <class T>
  void write_pieces(const std::string& name, int width, RowPart part,
                    const std::function<const T*(std::int64_t first, std::int64_t count)>& piece) {
    write(name, {hdf5_type<T>(), width}, part, piece);
  }

 private:
  struct RowType {
    hid_t value;
    int width;
    std::size_t bytes() const { return static_cast<std::size_t>(width) * H5Tget_size(value); }
  };
  using Piece = std::function<const void*(std::int64_t first, std::int64_t count)>;
  void write(const std::string& name, RowType type, RowPart part, const Piece& piece);
  void write_collectively(const std::string& name, RowType type, RowPart part, const Piece& piece);
  void write_through_root(const std::string& name, RowType type, RowPart part, const Piece& piece);
  void put(const std::string& name, RowType type, RowPart rows, const void* values);
  void read_back();
  bool has_file() const { return collective_ || ranks_.is_root(); }
  [[noreturn]] void fail(const std::string& action) const;

  // What this rank has written without reserved space.
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
