// A simulated full disk for tests: files of this process cannot grow.
#pragma once

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>

namespace scree {

// Limits the size of files that this process writes, for the lifetime of the object.
class FileSizeLimit {
 public:
  static constexpr rlim_t kNone = RLIM_INFINITY;

  FileSizeLimit() {
    signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit fails
    getrlimit(RLIMIT_FSIZE, &before_);
  }
  ~FileSizeLimit() { lift(); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  void set(rlim_t bytes) const {
    const rlimit limit{std::min(bytes, before_.rlim_cur), before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  void lift() const { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace scree
