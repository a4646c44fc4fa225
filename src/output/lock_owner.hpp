// The run that has a folder, as the text of its lock says, and whether it is over.
#pragma once

#include <string>

namespace scree {

// Empty where the text does not say.
struct LockOwner {
  std::string host, boot;              // name; the machine's id since its last start
  std::string process, process_start;  // id; clock ticks since that start
  std::string job, job_start;          // of SLURM: id; how often it has been started again
  std::string since;                   // UTC

  static LockOwner this_process();
  static LockOwner read(const std::string& path);  // empty where there is no such file
  std::string text() const;                        // a line for each entry: its name and its value
  std::string described() const;                   // for a message; empty for an empty one
};

// What the operating system says of a lock; some file systems have none.
enum class LockState { free, held, unknown };

// Whether the run of `owner` is over, seen from the process `self`. on_own_disk: the file system is this
// machine's alone, so that the operating system's lock reaches all who might have it.
bool is_over(const LockOwner& owner, const LockOwner& self, LockState lock, bool on_own_disk);

}  // namespace scree
