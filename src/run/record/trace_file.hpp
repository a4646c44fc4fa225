// The timeline of --trace, in the JSON format of Chrome's trace viewer, which Perfetto opens.
#pragma once

#include <string>

#include "base/stage_trace.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Writes the events of all ranks, each as a process of the timeline, on rank 0. Collective. Throws IoError.
void write_trace(const std::string& path, const StageTrace& trace, const Ranks& ranks);

}  // namespace scree
