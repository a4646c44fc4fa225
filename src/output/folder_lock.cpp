#include "output/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "base/error.hpp"

namespace scree {

namespace {

// Queries the lock (F_OFD_GETLK) or takes it (F_OFD_SETLK). The lock ends when the process closes the file.
LockState state_of(int file, int command) {
  struct flock lock {};
  lock.l_type = F_WRLCK, lock.l_whence = SEEK_SET;
  if (fcntl(file, command, &lock) != 0)
    return errno == EACCES || errno == EAGAIN ? LockState::held : LockState::unknown;
  return command == F_OFD_GETLK && lock.l_type != F_UNLCK ? LockState::held : LockState::free;
}

bool is_on_own_disk(int file) {
  constexpr long kZfs = 0x2fc12fc1, kOwn[] = {EXT4_SUPER_MAGIC,
                                              XFS_SUPER_MAGIC,
                                              BTRFS_SUPER_MAGIC,
                                              TMPFS_MAGIC,
                                              F2FS_SUPER_MAGIC,
                                              OVERLAYFS_SUPER_MAGIC,
                                              kZfs};
  struct statfs system {};
  return fstatfs(file, &system) == 0 &&
         std::find(std::begin(kOwn), std::end(kOwn), system.f_type) != std::end(kOwn);
}

bool is_over(const LockOwner& owner, int file, LockState lock) {
  return is_over(owner, LockOwner::this_process(), lock, is_on_own_disk(file));
}

bool is_file(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

bool is_named(int file, const std::string& path) {
  struct stat open {
  }, named{};
  return fstat(file, &open) == 0 && stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

// Writes the owner into the lock file. Returns the system's error number, 0 on success.
int write_owner(int file) {
  const std::string text = LockOwner::this_process().text();
  const auto size = static_cast<ssize_t>(text.size());
  errno = ENOSPC;  // the reason for a truncated write
  if (pwrite(file, text.data(), text.size(), 0) != size || ftruncate(file, size) != 0) return errno;
  return fsync(file) == 0 ? 0 : errno;
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) : folder_(folder), path_(folder + "/scree.lock") {}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  unlink(path_.c_str());
  close(file_);
}

void FolderLock::refuse(const std::string& owner) const {
  throw InputError(fmt::format(
      "output folder {}: another run writes into it{}{}; wait for its end, or choose another folder with "
      "--output (if that run is dead, remove {})",
      folder_, owner.empty() ? "" : ": ", owner, path_));
}

void FolderLock::fail(const char* action, int error) const {
  throw IoError(fmt::format("{}: cannot {}: {}", path_, action, std::strerror(error)));
}

std::optional<LockOwner> FolderLock::owner() const {
  const int file = open(path_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  if (!is_file(file)) {  // not the lock of a run
    close(file);
    return std::nullopt;
  }
  const LockOwner owner = LockOwner::read(path_);
  // Read permission suffices to query a write lock, but not to take it.
  const bool over = is_over(owner, file, state_of(file, F_OFD_GETLK));
  close(file);
  return over ? std::nullopt : std::optional(owner);
}

// A link is not followed and cannot be opened.
void FolderLock::require_file() const {
  struct stat status {};
  if (lstat(path_.c_str(), &status) != 0 || S_ISREG(status.st_mode) || S_ISLNK(status.st_mode)) return;
  throw InputError(fmt::format(
      "output folder {}: {} is {}, but has the name of the lock file of a run; remove it, or choose "
      "another folder with --output",
      folder_, path_, S_ISDIR(status.st_mode) ? "a folder" : "no file"));
}

void FolderLock::check() const {
  require_file();
  if (const std::optional<LockOwner> other = owner()) refuse(other->described());
}

void FolderLock::take() {
  require_file();
  while (!try_to_take()) {
  }
}

// Does not take the lock if its owner has removed the file meanwhile: the next attempt creates a new one.
bool FolderLock::try_to_take() {
  int file = open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  const bool made = file >= 0;
  if (!made && errno == EEXIST) {
    file = open(path_.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0 && errno == ENOENT) return false;
  }
  if (file < 0) fail("open", errno);
  const LockOwner owner = LockOwner::read(path_);
  const LockState lock = state_of(file, F_OFD_SETLK);
  const bool free = made ? lock != LockState::held : is_over(owner, file, lock);
  const bool named = is_named(file, path_);
  if (!made && free && named &&
      lock != LockState::free) {  // the next attempt creates a file that can be locked
    const int error = unlink(path_.c_str()) == 0 ? 0 : errno;
    close(file);
    if (error != 0 && error != ENOENT) fail("remove", error);
    return false;
  }
  const int error = free && named ? write_owner(file) : 0;
  if (free && named && error == 0) {
    file_ = file;
    return true;
  }
  if (error != 0) unlink(path_.c_str());
  close(file);
  if (error != 0) fail("write", error);
  if (named) refuse(owner.described());
  return false;
}

}  // namespace scree
