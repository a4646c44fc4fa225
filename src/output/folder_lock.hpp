// Keeps a second run out of the folder that a first one writes into, and lets the next one in where the first
// was killed.
//
// The lock is a file with the name of host and process in it, and with a lock of the operating system on it,
// which ends with its process. On a disk of this machine that alone decides. On a shared file system, where
// it may not reach from host to host, the text does: a process of this host can be looked up; one of another
// host counts as alive, unless it belongs to an earlier start of the same SLURM job.
#pragma once

#include <optional>
#include <string>

#include "output/lock_owner.hpp"

namespace scree {

class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);
  ~FolderLock();  // lets go
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  // The run that has the folder, as far as this process can tell; empty where there is none.
  std::optional<LockOwner> owner() const;
  // Throws InputError, which names the process, where another run has the folder, and where something else
  // than a file has the lock's name. check() changes nothing.
  void check() const;
  // The folder exists. Throws IoError, too.
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
