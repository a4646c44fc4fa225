// What the conditions that end a run have seen so far; part of the state, complete on rank 0.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "output/checkpoint.hpp"

namespace scree {

struct StopSample {
  Real time = 0, value = 0;  // of a row of the history [s], [the column's unit]

  friend bool operator==(const StopSample&, const StopSample&) = default;
};

struct StopWatch {
  std::int64_t condition = 0;  // key_of() of its condition
  // The rows at which the condition has held up to now, oldest first: with bounds the first and the last one,
  // with a band all those that decide about it. Empty: it did not hold at the last row.
  std::vector<StopSample> held;

  friend bool operator==(const StopWatch&, const StopWatch&) = default;
};

// Adds the datasets stop/conditions, stop/rows and stop/samples; none without watches.
void add_watches(const std::vector<StopWatch>& watches, Checkpoint& out);
// The watches of a checkpoint. Throws IoError naming the file if the datasets do not fit together, or a value
// is not finite.
std::vector<StopWatch> watches_in(const Checkpoint& in);

}  // namespace scree
