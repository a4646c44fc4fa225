#include <cmath>
#include <utility>

#include "cuda_implicit.cuh"
#include "dem/schedule/implicit_schedule.hpp"
#include "dem/schedule/six_freedoms.hpp"
#include "dem/schedule/three_freedoms.hpp"

namespace scree {
namespace {

void swap_motion(ParticleArrays& now, SecondArrays& start) {
  std::swap(now.position, start.position), std::swap(now.velocity, start.velocity);
  if (now.rotates) std::swap(now.angular_velocity, start.angular_velocity);
}

}  // namespace

void CudaImplicitArrays::resize(const CudaItems& items) {
  step.resize({static_cast<std::size_t>(items.owned), static_cast<std::size_t>(items.layout.items),
               static_cast<std::size_t>(items.list.slots()),
               static_cast<std::size_t>(items.surfaces.entries()), items.kernels->traits().rolls},
              items.model.rotates());
}

// The state at the start of the step is kept by swapping the arrays, last: an error before leaves them.
CudaImplicitOperations::CudaImplicitOperations(CudaItems& items, CudaBodies& bodies,
                                               CudaImplicitArrays& arrays, Real h)
    : items_(items), bodies_(bodies), arrays_(arrays), h_(h) {
  const auto n = static_cast<std::size_t>(items.owned);
  copy_async(start().acceleration.data(), now().acceleration.data(), n, items.stream);
  if (now().rotates)
    copy_async(start().angular_acceleration.data(), now().angular_acceleration.data(), n, items.stream);
  side().store_start(), items.surfaces.store_start(items.device());
  swap_motion(now(), start());
}

void CudaImplicitOperations::undo() {
  const auto n = static_cast<std::size_t>(items_.owned);
  swap_motion(now(), start());
  copy_async(now().acceleration.data(), start().acceleration.data(), n, items_.stream);
  if (now().rotates)
    copy_async(now().angular_acceleration.data(), start().angular_acceleration.data(), n, items_.stream);
  items_.refresh_ghosts();
}

Real CudaImplicitOperations::largest_displacement() {
  DeviceResults& results = items_.results;
  const DisplacementItem moved{start().position.data(), now().position.data()};
  max_over(items_.device(), items_.layout.active, moved, results.at(&Results::largest));
  return std::sqrt(results.fetch(&Results::largest));
}

void CudaImplicitOperations::refresh_ghosts(Device on) {
  items_.refresh_ghosts(on);
  if (now().rotates) items_.halo_stream.halo.update(on, arrays().six.mean_spin.data(), items_.owned);
}

void CudaImplicitOperations::copy_queued() {
  if (max_is_queued_) items_.results.copy(&Results::largest);
  if (sum_is_queued_) items_.results.copy(&Results::slope);
  max_is_queued_ = sum_is_queued_ = false;
}

void CudaImplicitOperations::wait_for_queued() {
  if (!max_is_queued_ && !sum_is_queued_) return;
  copy_queued();
  wait_for(items_.stream);
}

// Waits.
FrictionNorms CudaImplicitOperations::norms() {
  copy_queued();
  const FrictionNorms own = items_.results.fetch(&Results::norms);
  items_.halo_stream.clock.read(items_.balance.halo);
  Real maxima[5] = {own.residual, own.correction_bound, own.force, own.stiffness_ratio, own.phase_squared};
  items_.ranks.max(maxima);
  return {{maxima[0], maxima[1], maxima[2], maxima[3]}, maxima[4]};
}

void CudaImplicitOperations::lag_limits(const FrictionStart& start) {
  const auto clear = [&](DeviceArray<Real>& limits, std::int64_t n) {  // all bits set, a NaN: no contact
    limits.resize(static_cast<std::size_t>(n));
    const std::size_t bytes = static_cast<std::size_t>(n) * sizeof(Real);
    if (n > 0) require_cuda(cudaMemsetAsync(limits.data(), 0xff, bytes, items_.stream), "cudaMemsetAsync");
  };
  DeviceArray<Real>&neighbors = arrays().six.neighbor_limits, &surfaces = arrays().six.surface_limits;
  clear(neighbors, items_.list.entries());
  clear(surfaces, items_.surfaces.entries());
  queue_with_ghosts([](Device, Index, Index) {}, nullptr);
  items_.kernels->run(items_.device(), items_.views(), items_.owned,
                      LimitRequest{start, {neighbors.data(), surfaces.data()}});
}

void CudaImplicitOperations::account_contacts(const FrictionStart& start) {
  const LossRequest request{start,
                            {now().contact_loss.data(),
                             now().integrator_loss.data(),
                             {SCREE_LOSS_KINDS(SCREE_LOSS_POINTER, now())}}};
  items_.kernels->run(items_.device(), items_.views(), items_.owned, request);
  items_.surfaces.accumulate_step_works(items_.device(), *items_.kernels);
  items_.history.accepted();
}

std::unique_ptr<ImplicitStep> open_cuda_step(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays,
                                             Real h) {
  using On = CudaImplicitOperations;
  if (items.model.rotates() && items.kernels->traits().rolls)
    return std::make_unique<ImplicitSchedule<On, RollingFreedoms>>(items, bodies, arrays, h);
  if (items.model.rotates())
    return std::make_unique<ImplicitSchedule<On, SixFreedoms>>(items, bodies, arrays, h);
  return std::make_unique<ImplicitSchedule<On, ThreeFreedoms>>(items, bodies, arrays, h);
}

}  // namespace scree
