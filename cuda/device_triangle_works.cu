#include "device_triangle_works.cuh"
#include "for_each.cuh"

namespace scree {
namespace {

// Integer additions give the same bits in any order of the threads.
struct AtomicAdd {
  __device__ static void add(std::int64_t& limb, std::int64_t term) {
    atomicAdd(reinterpret_cast<unsigned long long*>(&limb), static_cast<unsigned long long>(term));
  }
};

template <class Works>
using WorkItem = TriangleWorkItem<Works, AtomicAdd>;

struct WorkInRunItem {
  WorkItem<ExplicitWorks> work;
  const VerletControl* control;

  __device__ void operator()(Index g) const {
    if (!control->stop) work(g);
  }
};

}  // namespace

DeviceTriangleWorks::DeviceTriangleWorks(const Model& model, cudaStream_t stream) : works_(model) {
  if (!exist()) return;
  first_.upload(works_.first(), stream), wear_.upload(works_.wear(), stream);
  load({}, stream);
}

void DeviceTriangleWorks::reserve_entries(Device device, std::int64_t contacts) {
  if (exist() && !terms_.take(contacts))
    for_each(device, static_cast<Index>(works_.triangles()), NormalizeItem{sums_.data()});
}

template <class Works>
void DeviceTriangleWorks::accumulate(Device device, const SurfaceViews& in, Index groups,
                                     const Works& works) {
  if (exist()) for_each(device, groups, WorkItem<Works>{in, table(), works, sums_.data()});
}
template void DeviceTriangleWorks::accumulate(Device, const SurfaceViews&, Index, const ExplicitWorks&);
template void DeviceTriangleWorks::accumulate(Device, const SurfaceViews&, Index, const ImplicitWorks&);
template void DeviceTriangleWorks::accumulate(Device, const SurfaceViews&, Index,
                                              const ImplicitFrictionWorks&);

void DeviceTriangleWorks::accumulate_in_run(Device device, const SurfaceViews& in, Index groups,
                                            const ExplicitWorks& works, const VerletControl* control) {
  if (exist()) for_each(device, groups, WorkInRunItem{{in, table(), works, sums_.data()}, control});
}

void DeviceTriangleWorks::load(const std::vector<std::int64_t>& words, cudaStream_t stream) {
  if (exist()) sums_.upload(works_.sums(words), stream);
}

std::vector<std::int64_t> DeviceTriangleWorks::limbs(cudaStream_t stream) const {
  return exist() ? works_.limbs(sums_.download(stream)) : std::vector<std::int64_t>{};
}

}  // namespace scree
