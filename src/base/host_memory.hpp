// The memory of the host that this process can still get.
#pragma once

#include <string>

#include "base/types.hpp"

namespace scree {

// One bound, and what sets it, in words: "MemAvailable of /proc/meminfo".
struct MemoryBound {
  Real bytes = kInfinity;
  std::string set_by;
};

struct FreeMemory {
  MemoryBound host;     // for all processes of the host, or of this process's control group, together
  MemoryBound process;  // for this process alone: the limits of its shell
};

// The tightest bounds now: the host's available memory, the limits of the control groups that this process is
// in (version 1 and 2) less what they use, and the limits on the address space and on the data segment. A
// bound that cannot be read counts as none. root: where proc/ and sys/ are, for tests.
FreeMemory free_memory(const std::string& root = "");

}  // namespace scree
