// The two parts of an explicit step: the particles that can be advanced at once, and those that wait.
#pragma once

#include "contact_kernels.cuh"
#include "device.cuh"
#include "device_surfaces.cuh"

namespace scree {

// Particles whose block meets neither ghosts nor placed surfaces go ahead while the others wait for the halo
// and for the contacts with those surfaces.
class StepParts {
 public:
  // For a new list. The first `interior` of the particles, whole blocks, meet no ghosts; on a rank alone,
  // whose ghosts are there before the step, that is of no account. Waits where there are placed surfaces.
  void find(Device device, const DeviceSurfaces& surfaces, Index owned, Index interior, bool alone);

  // Whether there are placed surfaces and so many particles away from them that both parts pay.
  bool apart() const { return apart_; }
  // Launches that are all of a step, on a rank alone, or its parts; early ones may be none.
  StepRows whole() const { return {nullptr, 0, all_, owned_, alone_, all_}; }
  StepRows early() const {
    return {apart_ ? blocks_.data() : nullptr, 0, early_, owned_, false, early_ + late_blocks()};
  }
  StepRows late() const {
    if (apart_) return {blocks_.data() + early_, 0, late_blocks(), owned_, false, all_};
    return {nullptr, static_cast<Index>(early_), late_blocks(), owned_, false, early_ + late_blocks()};
  }

 private:
  // A step is closed by its last block, of which there must be one.
  unsigned late_blocks() const { return all_ > early_ ? all_ - early_ : 1; }

  Index owned_ = 0;
  unsigned all_ = 1, early_ = 0;  // blocks
  bool alone_ = true, apart_ = false;
  DeviceArray<Index> blocks_;  // those that are early, then the others
  DeviceArray<Index> count_{1};
  DeviceArray<unsigned char> early_flags_, space_;
  unsigned multiprocessors_ = static_cast<unsigned>(multiprocessors());
};

}  // namespace scree
