// How loops over items are launched as kernels. No result depends on it; tests vary it to show that.
#pragma once

#include <optional>

namespace scree {

struct Launches {
  int block = 128;  // threads per block where a kernel does not set it: whole warps, at most 256
  // Which form of an explicit step's kernel runs, see `PrunedRows`: several entries of a row at once, or one
  // by one; unset: whichever suits the number of particles.
  std::optional<bool> several_at_once;
  // Whether the particles of an explicit step away from placed surfaces are launched separately, see
  // `StepParts`; unset: if that pays.
  std::optional<bool> in_parts;
};

// Of the program; to be changed only while no backend exists.
inline Launches& launches() {
  static Launches chosen;
  return chosen;
}

}  // namespace scree
