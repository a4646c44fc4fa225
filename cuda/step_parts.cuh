// The two parts of an explicit step: the interior, which can be advanced at once, and the boundary, which
// waits.
#pragma once

#include "contact_kernels.cuh"
#include "device.cuh"
#include "device_surfaces.cuh"

namespace scree {

// Blocks of particles with neither ghosts nor placed surfaces near them are advanced while the others wait
// for the halo exchange and the contacts with surfaces.
class StepParts {
 public:
  // For a new list. The first `interior` particles, in whole blocks, have no ghost neighbours; this does not
  // matter on a single rank, whose ghosts are refreshed before the step. Waits if there are placed surfaces.
  void find(Device device, const DeviceSurfaces& surfaces, Index owned, Index interior, bool alone);

  // Whether there are placed surfaces, and enough particles away from them that two launches pay.
  bool apart() const { return apart_; }
  // Launches: the whole step, for a single rank, or its two parts; the interior may be empty.
  StepRows whole() const { return {nullptr, 0, all_, owned_, alone_, all_}; }
  StepRows interior() const {
    return {apart_ ? blocks_.data() : nullptr,   0, interior_blocks_, owned_, false,
            interior_blocks_ + boundary_blocks()};
  }
  StepRows boundary() const {
    if (apart_) return {blocks_.data() + interior_blocks_, 0, boundary_blocks(), owned_, false, all_};
    return {nullptr, static_cast<Index>(interior_blocks_), boundary_blocks(), owned_,
            false,   interior_blocks_ + boundary_blocks()};
  }

 private:
  // The last block of a step closes it, so a step needs at least one.
  unsigned boundary_blocks() const { return all_ > interior_blocks_ ? all_ - interior_blocks_ : 1; }

  Index owned_ = 0;
  unsigned all_ = 1, interior_blocks_ = 0;  // number of blocks
  bool alone_ = true, apart_ = false;
  DeviceArray<Index> blocks_;  // block numbers: the interior first, then the boundary
  DeviceArray<Index> count_{1};
  DeviceArray<unsigned char> is_interior_, space_;
  unsigned multiprocessors_ = static_cast<unsigned>(multiprocessors());
};

}  // namespace scree
