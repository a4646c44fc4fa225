// Host memory that this process can still allocate.
#pragma once

#include <string>

#include "base/types.hpp"

namespace scree {

// A bound [B], and the text on its origin: "MemAvailable of /proc/meminfo".
struct MemoryBound {
  Real bytes = kInfinity;
  std::string set_by;
};

struct FreeMemory {
  MemoryBound host;     // for all processes of the host, or of this process's control group, together
  MemoryBound process;  // for this process alone: resource limits of its shell
};

// The tightest bounds at present: available memory of the host, limits of this process's control groups
// (version 1 and 2) less their usage, and limits on address space and data segment. A bound that cannot be
// read is ignored. root: folder with proc/ and sys/, for tests.
FreeMemory free_memory(const std::string& root = "");

}  // namespace scree
