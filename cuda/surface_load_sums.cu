#include <algorithm>
#include <atomic>

#include "base/index.hpp"
#include "surface_load_sums.cuh"

namespace scree {
namespace {

// Chunks of so many entries.
Index parts_of(Index entries) { return (entries + kLoadLanes - 1) / kLoadLanes; }

}  // namespace

void SurfaceLoadSums::prepare(Device device, std::span<const Index> starts) {
  const std::size_t surfaces = starts.size() - 1;
  std::size_t count = 0;
  for (std::size_t s = 0; s < surfaces; ++s) count += as_size(parts_of(starts[s + 1] - starts[s]));
  h_chunks_.resize_with_spare(count);
  count = 0;
  has_chunks_.assign(surfaces, false);
  for (std::size_t s = 0; s < surfaces; ++s) {
    const auto first_part = static_cast<Index>(count), parts = parts_of(starts[s + 1] - starts[s]);
    has_chunks_[s] = parts > 0;
    for (Index first = starts[s]; first < starts[s + 1]; first += kLoadLanes)
      h_chunks_[count++] = {
          {static_cast<Index>(s), first, std::min(first + kLoadLanes, starts[s + 1])}, first_part, parts};
  }
  chunks_.resize_with_spare(count);
  copy_async(chunks_.data(), h_chunks_.data(), count, device.stream);
  of_chunks_.resize_with_spare(count);
  if (summed_.size() == 0) summed_.resize(surfaces), summed_.zero(device.stream);
  sums_.resize(surfaces), written_by_.resize(surfaces);
  for (std::size_t s = 0; s < surfaces; ++s) sums_[s].contacts = 0, written_by_[s] = evaluation_;
}

LoadSumOutputs SurfaceLoadSums::next(const ControlReport& report) {
  return {of_chunks_.data(), summed_.data(), sums_.data(), written_by_.data(), ++evaluation_, report};
}

bool SurfaceLoadSums::have_arrived() const {
  for (std::size_t s = 0; s < has_chunks_.size(); ++s) {
    // The reference is to memory that the device writes; atomic_ref takes no constants before C++26.
    std::atomic_ref<unsigned> written_by(const_cast<unsigned&>(written_by_[s]));
    if (has_chunks_[s] && written_by.load(std::memory_order_acquire) != evaluation_) return false;
  }
  return true;
}

// Without the driver: to synchronize with a stream takes longer than to see what a kernel has written. The
// driver is asked now and then, so that an error of the device ends the wait.
void SurfaceLoadSums::await(cudaStream_t stream) const {
  constexpr int kLooks = 10000;  // some 0.1 ms
  const StageTrace::Wait traced;
  for (;;) {
    for (int look = 0; look < kLooks; ++look)
      if (have_arrived()) return;
    const cudaError_t status = cudaStreamQuery(stream);
    if (status == cudaErrorNotReady) {
      cudaGetLastError();  // or the next launch would report it
      continue;
    }
    return require_cuda(status, "contacts with bodies");
  }
}

std::vector<InstantSums> SurfaceLoadSums::touched() const {
  std::vector<InstantSums> out;
  for (std::size_t s = 0; s < sums_.size(); ++s)
    if (sums_[s].contacts > 0) out.push_back(sums_[s]);
  return out;
}

}  // namespace scree
