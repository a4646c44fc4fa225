// The starts of a run: at t = 0, and from each checkpoint that it went on from, with what each took.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

// One start of the program. Of an earlier one all is as of the checkpoint that the next start went on from:
// what came after it is taken anew, and counts there.
struct RunStart {
  std::string started;  // ISO 8601, UTC
  std::string host, backend;
  std::int64_t ranks = 1;
  Real from = 0, to = 0;   // simulated time [s]
  std::int64_t steps = 0;  // accepted on the way
  Real wall_seconds = 0;   // since the start
  Real loop_seconds = 0;   // of these in the steps, output between them included
  Real cpu_seconds = 0;    // of rank 0
};

// Steps and seconds of all of them; the rest is the first one's but for `to`.
RunStart sum_of(const std::vector<RunStart>& starts);

// As TOML and back, bit for bit. Throws IoError naming `path`, where the text comes from, if it is damaged.
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
