#include "output/double_buffered_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "output/durable_file.hpp"

namespace scree {

namespace fs = std::filesystem;

DoubleBufferedFile::DoubleBufferedFile(const std::string& path, const Ranks& ranks,
                                       std::int64_t likely_chunks)
    : ranks_(ranks),
      path_(path),
      spare_(path + ".spare"),
      old_(path + ".old"),
      likely_chunks_(likely_chunks) {
  drop_spare();
}

DoubleBufferedFile::~DoubleBufferedFile() { drop_spare(); }

void DoubleBufferedFile::drop_spare() {
  has_spare_ = false;
  if (!ranks_.is_root()) return;
  std::error_code ignored;  // usually there is nothing to remove
  fs::remove(spare_, ignored);
  fs::remove(old_, ignored);
}

bool DoubleBufferedFile::exists() const {
  bool there = false;
  ranks_.on_root([&] { there = fs::exists(path_); });
  ranks_.broadcast(there);
  return there;
}

void DoubleBufferedFile::remove() {
  drop_spare();
  ranks_.on_root([&] {
    std::error_code error;
    fs::remove(path_, error);
    if (error) throw IoError(fmt::format("{}: cannot remove: {}", path_, error.message()));
  });
}

// Serial writes need one opening; a collective write requires that the file is closed in between.
void DoubleBufferedFile::change_spare(const Change& change, Hdf5Access access) {
  const bool together = kParallelHdf5 && !ranks_.alone();
  std::optional<Hdf5File> file;
  ranks_.on_root([&] {
    file.emplace(spare_, access, likely_chunks_);
    if (change.layout) change.layout(*file);
    if (together) file->close();
  });
  if (change.rows && together) {
    SharedRows rows(ranks_, spare_);
    change.rows(rows);
    rows.close();
  } else if (change.rows) {
    SharedRows rows(ranks_, file ? &*file : nullptr);
    change.rows(rows);
  }
  ranks_.on_root([&] {
    if (!together) file->close();
  });
}

void DoubleBufferedFile::update(const Change& change) {
  prepare(change);
  show();
  ranks_.on_root([&] { sync_folder_of(path_); });
  follow(change);
}

void DoubleBufferedFile::prepare(const Change& change) {
  const bool ready = std::exchange(has_spare_, false);
  try {
    const bool grows = exists();
    if (grows && !ready) ranks_.on_root([&] { copy_file(path_, spare_); });
    change_spare(change, grows ? Hdf5Access::modify : Hdf5Access::create);
    // Any rank's host may hold data that is not yet on disk.
    ranks_.collectively([&] { sync_file(spare_); });
  } catch (...) {
    drop_spare();
    throw;
  }
}

void DoubleBufferedFile::show() {
  bool exchanged = false;
  ranks_.on_root([&] { exchanged = exchange_files(spare_, path_, old_); });
  ranks_.broadcast(exchanged);
  has_spare_ = exchanged;
}

void DoubleBufferedFile::follow(const Change& change) {
  if (!has_spare_) return;
  try {
    change_spare(change, Hdf5Access::modify);
  } catch (const IoError&) {
    // A reader that opened this copy while it was visible holds a lock on it. That is harmless: the visible
    // copy is complete, and the next update creates another copy, which would also report a full disk.
    drop_spare();
  }
}

}  // namespace scree
