#include "output/twin_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.hpp"
#include "output/durable_file.hpp"

namespace scree {

namespace fs = std::filesystem;

TwinFile::TwinFile(const std::string& path, const Ranks& ranks)
    : ranks_(ranks), path_(path), spare_(path + ".spare"), old_(path + ".old") {
  drop_spare();
}

TwinFile::~TwinFile() { drop_spare(); }

void TwinFile::drop_spare() {
  has_spare_ = false;
  if (!ranks_.is_root()) return;
  std::error_code ignored;  // nothing to remove is the usual case
  fs::remove(spare_, ignored);
  fs::remove(old_, ignored);
}

bool TwinFile::exists() const {
  bool there = false;
  ranks_.on_root([&] { there = fs::exists(path_); });
  ranks_.broadcast(there);
  return there;
}

void TwinFile::remove() {
  drop_spare();
  ranks_.on_root([&] {
    std::error_code error;
    fs::remove(path_, error);
    if (error) throw IoError(fmt::format("{}: cannot remove: {}", path_, error.message()));
  });
}

void TwinFile::change_spare(const Change& change, Hdf5Access access) {
  ranks_.on_root([&] {
    Hdf5File file(spare_, access);
    if (change.layout) change.layout(file);
    file.close();
  });
  if (!change.rows) return;
  SharedRows rows(ranks_, spare_);
  change.rows(rows);
  rows.close();
}

void TwinFile::copy_to_spare() {
  ranks_.on_root([&] { copy_file(path_, spare_); });
}

void TwinFile::update(const Change& change) {
  try {
    const bool grows = exists();
    if (grows && !has_spare_) copy_to_spare();
    change_spare(change, grows ? Hdf5Access::modify : Hdf5Access::create);
    swap_in();
  } catch (...) {
    drop_spare();
    throw;
  }
  if (has_spare_) catch_up(change);
}

void TwinFile::catch_up(const Change& change) {
  try {
    change_spare(change, Hdf5Access::modify);
  } catch (const IoError&) {
    // A reader that opened this copy while it was the visible one holds a lock on it. It may keep it: the
    // visible copy is complete, and the next update makes another. A full disk comes up again there.
    drop_spare();
  }
}

// Every rank's machine may hold some of the file that is not on disk yet.
void TwinFile::swap_in() {
  ranks_.together([&] { sync_file(spare_); });
  bool kept = false;
  ranks_.on_root([&] {
    // Two names for the visible copy, so that it outlives the rename; without hard links it is copied next
    // time.
    std::error_code error;
    fs::remove(old_, error);
    fs::create_hard_link(path_, old_, error);
    const bool linked = !error;
    replace_file(spare_, path_);
    if (linked) fs::rename(old_, spare_, error);
    kept = linked && !error;
  });
  ranks_.broadcast(kept);
  has_spare_ = kept;
}

}  // namespace scree
