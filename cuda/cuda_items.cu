#include "cuda_items.cuh"

namespace scree {
namespace {

struct IsNotFinite {
  const Vec3* force;
  __device__ bool operator()(Index i) const { return !is_finite(force[i]); }
};

}  // namespace

CudaItems::CudaItems(const Model& of, const Ranks& on, const std::function<void()>& work,
                     std::unique_ptr<DeviceContactKernels> law)
    : model(of),
      ranks(on),
      subdomain(of.space),
      hht(hht_coefficients(of.integrator.hht_alpha)),
      idle_work(work),
      kernels(std::move(law)),
      surfaces(of, subdomain.period(), stream),
      lane(on, of.parallel.transport),
      list(kernels->history() > 0),
      history(kernels->history(), {of.space.min, subdomain.period()}, stream),
      results(on, stream) {
  static_cast<FieldsThere&>(now) = static_cast<FieldsThere&>(other) = fields_there(of);
}

DeviceViews CudaItems::views(const Vec4* position, const Vec4* velocity, const Vec4* spin) {
  DeviceViews views = surfaces.views(position, velocity, now.material.data(), list.rows());
  views.history = history.views(), views.spin = spin, views.reach = model.contact.reach;
  return views;
}

void CudaItems::reorder(const Index* order, Index n) {
  const auto size = static_cast<std::size_t>(n);
  other.grow(std::max(size, now.position.size()), size, 0, stream);
  for_each(device(), n, ReorderItem{views_of(now), views_of(other), order});
  history.reorder(order, n);
  std::swap(now, other);
  owned = n;
}

void CudaItems::halo_after_rows() {
  if (!ranks.alone()) fork_lane();
}

void CudaItems::rows_after_halo() {
  if (!ranks.alone()) join_lane();
}

void CudaItems::report_not_finite(const Vec3* force) {
  if (const long long id = smallest_id(IsNotFinite{force}); id < kNoId)
    throw SimulationError("stage contact_force: the force on particle " + std::to_string(id) +
                          " is not finite");
}

}  // namespace scree
