// The run that owns a folder, according to the text of its lock, and whether that run is over.
#pragma once

#include <string>

namespace scree {

// Entries are empty if the text does not have them.
struct LockOwner {
  std::string host, boot;              // host name; id of the machine since its last boot
  std::string process, process_start;  // process id; start in clock ticks since boot
  std::string job, job_start;          // of SLURM: job id; number of restarts of the job
  std::string since;                   // UTC

  static LockOwner this_process();
  static LockOwner read(const std::string& path);  // empty if there is no such file
  std::string text() const;                        // one line per entry: name and value
  std::string described() const;                   // for messages; empty for an empty owner
};

// State of a lock according to the operating system; unknown on file systems without locks.
enum class LockState { free, held, unknown };

// Whether the run of `owner` is over, seen from the process `self`. on_own_disk: the file system belongs to
// this machine alone, so that the operating system's lock works for every process.
bool is_over(const LockOwner& owner, const LockOwner& self, LockState lock, bool on_own_disk);

}  // namespace scree
