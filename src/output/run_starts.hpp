// The starts of a run, at t = 0 and from checkpoints, with the cost of each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

// One start of the program. An earlier start counts up to the checkpoint from which the next one continued:
// what came after it is computed again and counts there.
struct RunStart {
  std::string started;  // ISO 8601, UTC
  std::string host, backend;
  std::int64_t ranks = 1;
  Real from = 0, to = 0;   // simulated time [s]
  std::int64_t steps = 0;  // accepted steps
  Real wall_seconds = 0;   // wall time since the start
  Real loop_seconds = 0;   // part of it in the step loop, with output between steps
  Real cpu_seconds = 0;    // on rank 0
};

// The sum of steps and seconds; the last entry's `to`, and otherwise the first entry's values.
RunStart sum_of(const std::vector<RunStart>& starts);

// Conversion to TOML and back, bit for bit. path: origin of the text, for IoError if it is damaged.
std::string to_text(const std::vector<RunStart>& starts);
std::vector<RunStart> starts_in(const std::string& text, const std::string& path);

// Calls use(name, value) for each member.
template <class Start, class Use>
void for_each_entry(Start& start, const Use& use) {
  use("started", start.started), use("host", start.host), use("backend", start.backend);
  use("ranks", start.ranks), use("from", start.from), use("to", start.to), use("steps", start.steps);
  use("wall_seconds", start.wall_seconds), use("loop_seconds", start.loop_seconds);
  use("cpu_seconds", start.cpu_seconds);
}

}  // namespace scree
