// Surfaces with prescribed motion in a run of explicit steps, which the host queues as far ahead as beside
// surfaces at rest: a table of their poses in the next steps, and the sums of their contacts in each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "contact_kernels.cuh"
#include "dem/host/host_surfaces.hpp"
#include "dem/host/step_loads.hpp"
#include "device.cuh"
#include "device_surfaces.cuh"

namespace scree {

// Chunks of the entries of one surface.
struct SurfaceParts {
  Index first, count;
};

// Arguments of the kernel that sums the loads of a step.
struct LoadSums {
  SurfaceChunks chunks;
  const SurfaceParts* parts;  // per surface
  const Index* by_surface;
  const SurfaceLoad* loads;
  const Index* opened;  // as in PosesInRun
  InstantSums* of_chunks;
  unsigned* finished;  // per surface: number of its chunks that are summed
  InstantSums* sums;   // [rows][surfaces], in the memory of the host
  Index surfaces;
};

class DrivenSurfaces {
 public:
  static constexpr Index kRows = 128;  // the most steps queued at once

  // Sizes the tables; again for each new list. builds: number of the list.
  void prepare(const HostSurfaces& side, const DeviceSurfaces& surfaces, std::int64_t builds,
               cudaStream_t stream);
  // Puts the present poses into the row of a step, on the host; upload() queues the copy of n rows from that
  // of step `first` on. closed: steps closed before that step, as counted by the control block.
  void put(Index closed, const HostSurfaces& side);
  void upload(Index closed, Index n, cudaStream_t stream);
  PosesInRun poses() const { return poses_; }

  // Queues the sums of the loads that `on` has evaluated before, concurrently with what it queues next.
  // join(): what is queued on `on` from now on waits for them. key: everything that these depend on.
  void queue_sums(Device on);
  void join(Device on) const;
  std::string key() const;
  // Appends the sums of a step that the device has closed. step: its number in StepLoads.
  void take(Index closed, std::int64_t step, std::vector<StepLoads>& loads) const;

 private:
  void allocate(const HostSurfaces& side, cudaStream_t stream);

  PosesInRun poses_;
  LoadSums sums_{};
  std::int64_t known_list_ = -1;
  std::vector<SurfaceParts> h_parts_;
  PinnedArray<SurfacePose> h_placed_;
  PinnedArray<SurfaceFrame> h_frames_;
  PinnedArray<InstantSums> h_sums_;
  DeviceArray<SurfacePose> placed_;
  DeviceArray<SurfaceFrame> frames_;
  DeviceArray<Index> opened_{1};
  DeviceArray<SurfaceParts> parts_;
  DeviceArray<InstantSums> of_chunks_;
  DeviceArray<unsigned> finished_;
  Stream stream_{Priority::urgent};
  Event loads_found_, summed_;
};

}  // namespace scree
