#include "output/twin_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.hpp"
#include "output/durable_file.hpp"

namespace scree {

namespace fs = std::filesystem;

TwinFile::TwinFile(const std::string& path) : path_(path), spare_(path + ".spare"), old_(path + ".old") {
  drop_spare();
}

TwinFile::~TwinFile() { drop_spare(); }

void TwinFile::drop_spare() {
  has_spare_ = false;
  std::error_code ignored;  // nothing to remove is the usual case
  fs::remove(spare_, ignored);
  fs::remove(old_, ignored);
}

bool TwinFile::exists() const { return fs::exists(path_); }

void TwinFile::remove() {
  drop_spare();
  std::error_code error;
  fs::remove(path_, error);
  if (error) throw IoError(fmt::format("{}: cannot remove: {}", path_, error.message()));
}

void TwinFile::change_spare(const std::function<void(Hdf5File&)>& change, Hdf5Access access) {
  Hdf5File file(spare_, access);
  change(file);
  file.close();
}

void TwinFile::copy_to_spare() {
  std::error_code error;
  fs::copy_file(path_, spare_, fs::copy_options::overwrite_existing, error);
  if (error) throw IoError(fmt::format("{}: cannot copy to {}: {}", path_, spare_, error.message()));
}

void TwinFile::update(const std::function<void(Hdf5File&)>& change) {
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

void TwinFile::catch_up(const std::function<void(Hdf5File&)>& change) {
  try {
    change_spare(change, Hdf5Access::modify);
  } catch (const IoError&) {
    // A reader that opened this copy while it was the visible one holds a lock on it. It may keep it: the
    // visible copy is complete, and the next update makes another. A full disk comes up again there.
    drop_spare();
  }
}

void TwinFile::swap_in() {
  sync_file(spare_);
  // Two names for the visible copy, so that it outlives the rename; without hard links it is copied next
  // time.
  std::error_code no_link;
  fs::remove(old_, no_link);
  fs::create_hard_link(path_, old_, no_link);
  replace_file(spare_, path_);
  has_spare_ = false;
  if (no_link) return;
  std::error_code error;
  fs::rename(old_, spare_, error);
  has_spare_ = !error;
}

}  // namespace scree
