#include "cuda_items.cuh"
#include "dem/backend/device.hpp"

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
      halo_stream(on, of.parallel.transport),
      list(kernels->traits().history > 0, slots_per_particle(of)),
      history(packed_content(of, kernels->traits().history), {of.space.min, subdomain.period()}, stream,
              {other, arena}),
      results(on, stream) {
  static_cast<FieldsThere&>(now) = fields_there(of);
  other.rotates = now.rotates, other.implicit = of.integrator.particles == ParticleIntegrator::hht;
}

DeviceViews CudaItems::views(const Vec4* position, const Vec4* velocity, const Vec4* spin) {
  DeviceViews views = surfaces.views(position, velocity, now.material.data(), list.rows());
  views.history = history.views(), views.spin = spin,
  views.interaction_range = model.contact.interaction_range;
  return views;
}

void CudaItems::reorder(const Index* order, Index n) {
  other.grow(now.position.size(), static_cast<std::size_t>(n));
  history.reorder(order, n, list_scratch());
  scree::reorder(device(), now, other, order, n, open_run != nullptr);
  owned = n;
}

void CudaItems::halo_after_rows() {
  if (!ranks.alone()) fork_halo_stream();
}

void CudaItems::rows_after_halo() {
  if (!ranks.alone()) join_halo_stream();
}

void CudaItems::report_not_finite(const Vec3* force) {
  if (const long long id = smallest_id(IsNotFinite{force}); id < kNoId)
    throw SimulationError("stage contact_force: the force on particle " + std::to_string(id) +
                          " is not finite");
}

}  // namespace scree
