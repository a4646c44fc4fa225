// An HDF5 file that grows, and that is complete and readable at every instant, a kill or a crash included.
//
// HDF5 updates a file's metadata in place, in many writes: a process that is killed in the middle of an
// append leaves a file that readers refuse or, worse, one with wrong values (measured: 41 of 1,000 kills). So
// the file exists twice while it grows. An append goes to the copy nobody sees, which is synced and then
// takes the file's name in one rename; when the names are on disk, too, the other copy is brought up to date
// the same way and waits. It is not synced, because nobody needs it after a crash. So an append costs one
// sync of the data and one of the folder, which files that grow together share. The price is twice the
// writing and, while the writer lives, twice the disk space; the cost of an append does not depend on the
// size of the file.
#pragma once

#include <functional>
#include <string>

#include "output/hdf5_file.hpp"
#include "output/shared_rows.hpp"

namespace scree {

// A file of several ranks: all functions but path() are collective, and fail on every rank where they fail on
// one.
class TwinFile {
 public:
  // Removes what a killed run may have left beside PATH (PATH.spare, PATH.old). PATH itself is not touched.
  // likely_chunks: of a new file, as Hdf5File's.
  explicit TwinFile(const std::string& path, const Ranks& ranks = {}, std::int64_t likely_chunks = 0);
  ~TwinFile();  // removes the copy; not collective
  TwinFile(const TwinFile&) = delete;
  TwinFile& operator=(const TwinFile&) = delete;

  const std::string& path() const { return path_; }
  bool exists() const;
  void remove();  // throws IoError

  // What happens to the file in one update: rank 0 does what only one can do, room for rows included, then
  // all ranks write their rows. Either may be missing.
  struct Change {
    std::function<void(Hdf5File&)> layout;
    std::function<void(SharedRows&)> rows;
  };
  // Runs `change` on the file, a new and empty one if there is none. It runs once per copy, so it must do the
  // same again. All of it or nothing becomes visible. Throws IoError.
  void update(const Change& change);

  // The parts of an update, for files that change together: first all prepare(), which is what may fail for
  // want of space, then all show(), then rank 0 syncs the folder, then all follow(). Without a show() nothing
  // has happened.
  void prepare(const Change& change);  // in the hidden copy, which is then on disk
  void show();                         // the hidden copy becomes the visible one
  void follow(const Change& change);   // in the other copy, now the hidden one

 private:
  void change_spare(const Change& change, Hdf5Access access);
  void drop_spare();

  Ranks ranks_;
  std::string path_, spare_, old_;
  std::int64_t likely_chunks_;
  bool has_spare_ = false;  // spare_ has the same content as path_, but for what follow() is about to do
};

}  // namespace scree
