// Checkpoints in memory, with the rows of their particles.
#pragma once

#include "output/checkpoint.hpp"

namespace scree {

// The checkpoint with its rows among the arrays: independent of the state or the file that it came from.
inline Checkpoint with_rows_as_arrays(Checkpoint checkpoint) {
  const auto take = [](auto& rows_by_name, auto& arrays) {
    for (const auto& [name, rows] : rows_by_name) {
      auto& values = arrays[name];
      values.resize(static_cast<std::size_t>(rows.count * rows.width));
      rows.copy(0, rows.count, values.data());
    }
    rows_by_name.clear();
  };
  take(checkpoint.real_rows, checkpoint.reals), take(checkpoint.integer_rows, checkpoint.integers);
  return checkpoint;
}

}  // namespace scree
