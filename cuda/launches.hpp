// How loops over items are launched as kernels. No result depends on it, and tests choose otherwise to show
// that.
#pragma once

#include <optional>

namespace scree {

struct Launches {
  int block = 128;  // threads of a block where a kernel does not fix them: whole warps, at most 256
  // Which form of an explicit step's kernel runs, see PrunedRows: several entries of a row at once, or one by
  // one; unset: as the particles fit on the GPU.
  std::optional<bool> several_at_once;
  // Whether an explicit step's particles away from placed surfaces are launched by themselves, see StepParts;
  // unset: if that pays.
  std::optional<bool> in_parts;
};

// Of the program; to be changed only while there is no backend.
inline Launches& launches() {
  static Launches chosen;
  return chosen;
}

}  // namespace scree
