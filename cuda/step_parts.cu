#include <thrust/iterator/counting_iterator.h>

#include <algorithm>
#include <cub/device/device_partition.cuh>

#include "for_each.cuh"
#include "step_parts.cuh"

namespace scree {
namespace {

// Separate launches cost more than they save if fewer interior blocks than this run per multiprocessor. With
// few blocks, interior rows also keep the contacts with surfaces waiting until the first of these blocks end.
constexpr unsigned kLeastBlocks = 8;

// Whether a block of particles has neither ghosts nor placed surfaces near it.
struct InteriorItem {
  SurfaceList surfaces;
  Index owned, interior;
  unsigned char* is_interior;

  __device__ void operator()(Index block) const {
    const Index first = block * kStepBlock, end = min(first + kStepBlock, owned);
    bool waits = end > interior;
    for (Index k = surfaces.offsets[first]; k < surfaces.offsets[end] && !waits; ++k)
      waits = !surfaces.numbers.is_static(surfaces.surfaces[k]);
    is_interior[block] = !waits;
  }
};

}  // namespace

void StepParts::find(Device device, const DeviceSurfaces& surfaces, Index owned, Index interior, bool alone) {
  owned_ = owned, alone_ = alone, apart_ = false;
  all_ = std::max(1u, blocks_for(owned, kStepBlock));
  interior_blocks_ = alone ? 0 : static_cast<unsigned>(interior / kStepBlock);
  if (!surfaces.any_placed() || owned == 0) return;
  const auto blocks = static_cast<Index>(all_);
  blocks_.resize(all_), is_interior_.resize(all_);
  for_each(device, blocks,
           InteriorItem{surfaces.list(), owned, alone ? owned : interior, is_interior_.data()});
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(
        cub::DevicePartition::Flagged(at, bytes, thrust::counting_iterator<Index>(0), is_interior_.data(),
                                      blocks_.data(), count_.data(), blocks, device.stream),
        "partition");
  });
  const auto found = static_cast<unsigned>(count_.download(device.stream)[0]);
  const bool pays = found >= kLeastBlocks * multiprocessors_;
  apart_ = found > 0 && found < all_ && launches().in_parts.value_or(pays);
  if (apart_) interior_blocks_ = found;
}

}  // namespace scree
