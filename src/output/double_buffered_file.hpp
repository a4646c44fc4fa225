// Double-buffered HDF5 file: it grows, and is complete and readable at any time, even after a kill or a
// crash.
//
// HDF5 updates the metadata of a file in place, in many writes: a process killed during an append leaves a
// file that readers refuse or, worse, one with wrong values (measured: 41 of 1,000 kills). Therefore the file
// exists twice while it grows. An append writes the hidden copy, which is synced and then renamed to the
// file's name; when the names are on disk, too, the other copy is updated in the same way and becomes the
// hidden one. That update is not synced, because the copy is not needed after a crash. An append therefore
// costs one sync of the data and one of the folder, which files that grow together share. The cost is that
// everything is written twice and, while the writer exists, stored twice; it does not depend on the size of
// the file.
#pragma once

#include <functional>
#include <string>

#include "output/hdf5_file.hpp"
#include "output/shared_rows.hpp"

namespace scree {

// A file of several ranks: all functions but path() are collective, and fail on every rank if they fail on
// one.
class DoubleBufferedFile {
 public:
  // Removes copies that a killed run may have left (PATH.spare, PATH.old); does not touch PATH.
  // likely_chunks: of a new file, as for Hdf5File.
  explicit DoubleBufferedFile(const std::string& path, const Ranks& ranks = {},
                              std::int64_t likely_chunks = 0);
  ~DoubleBufferedFile();  // removes the hidden copy; not collective
  DoubleBufferedFile(const DoubleBufferedFile&) = delete;
  DoubleBufferedFile& operator=(const DoubleBufferedFile&) = delete;

  const std::string& path() const { return path_; }
  bool exists() const;
  void remove();  // throws IoError

  // One update of the file: rank 0 executes `layout`, which also adds space for rows, then all ranks write
  // their rows. Either may be missing.
  struct Change {
    std::function<void(Hdf5File&)> layout;
    std::function<void(SharedRows&)> rows;
  };
  // Applies `change` to the file, or to a new, empty file if there is none. `change` is applied once per copy
  // and must do the same each time. All of it or nothing becomes visible. Throws IoError.
  void update(const Change& change);

  // The parts of an update, for files that change together: first prepare() of all, which may fail for lack
  // of space, then show() of all, then rank 0 syncs the folder, then follow() of all. Before show() nothing
  // has changed.
  void prepare(const Change& change);  // changes the hidden copy and syncs it
  void show();                         // makes the hidden copy the visible one
  void follow(const Change& change);   // applies the change to the other copy, now the hidden one

 private:
  void change_spare(const Change& change, Hdf5Access access);
  void drop_spare();

  Ranks ranks_;
  std::string path_, spare_, old_;
  std::int64_t likely_chunks_;
  bool has_spare_ = false;  // spare_ has the content of path_, except for a pending follow()
};

}  // namespace scree
