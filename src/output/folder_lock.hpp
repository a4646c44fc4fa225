// Lock of an output folder: it keeps a second run out, and admits the next run after the first was killed.
//
// The lock is a file with the names of host and process, and with a lock of the operating system, which ends
// with the process. On a disk of this machine the operating system's lock alone decides. On a shared file
// system, where it may not work between hosts, the text decides: processes of this host can be looked up; a
// process of another host counts as alive, unless it belongs to an earlier start of the same SLURM job.
#pragma once

#include <optional>
#include <string>

#include "output/lock_owner.hpp"

namespace scree {

class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);
  ~FolderLock();  // releases the lock
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  // The run that holds the folder, as far as this process can tell; empty if there is none.
  std::optional<LockOwner> owner() const;
  // Throws InputError, with the process, if another run holds the folder, or if something other than a file
  // has the name of the lock. check() changes nothing.
  void check() const;
  // Takes the lock of an existing folder. Throws IoError, too.
  void take();

 private:
  bool try_to_take();
  void require_file() const;
  [[noreturn]] void refuse(const std::string& owner) const;
  [[noreturn]] void fail(const char* action, int error) const;

  std::string folder_, path_;
  int file_ = -1;
};

}  // namespace scree
