// Sums of the loads of contacts with placed surfaces, which the device writes to the memory of the host.
#pragma once

#include <span>
#include <vector>

#include "contact_kernels.cuh"
#include "device.cuh"

namespace scree {

class SurfaceLoadSums {
 public:
  // For a new list, after a wait for the device since the last call. starts: first entry by_surface of each
  // surface, and the end.
  void prepare(Device device, std::span<const Index> starts);
  LoadChunks chunks() const { return {chunks_.data(), static_cast<Index>(chunks_.size())}; }
  // For the next evaluation. report: the control block that the first warp copies to the host, if any.
  LoadSumOutputs next(const ControlReport& report);
  // Waits until the sums of the last evaluation, queued on this stream, are on the host, and its report. What
  // else is queued on the stream may still be under way.
  void await(cudaStream_t stream) const;
  // Sums of the last evaluation, of the surfaces with contacts; after await(), or when the stream is done.
  std::vector<InstantSums> touched() const;

 private:
  bool have_arrived() const;

  PinnedArray<LoadChunk> h_chunks_;
  DeviceArray<LoadChunk> chunks_;
  DeviceArray<InstantSums> of_chunks_;
  DeviceArray<unsigned> summed_;  // per surface: number of its chunks; zero between evaluations
  unsigned evaluation_ = 0;       // number of the last one
  std::vector<bool> has_chunks_;  // per surface
  // Per surface with chunks: its sums, and the evaluation that wrote them, which is written last.
  PinnedArray<InstantSums> sums_;
  PinnedArray<unsigned> written_by_;
};

}  // namespace scree
