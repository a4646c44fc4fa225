// Implicit steps on the GPU: memory, kernels and communication for `ImplicitSchedule`.
#pragma once

#include <memory>
#include <type_traits>

#include "cuda_bodies.cuh"
#include "cuda_solver.cuh"
#include "dem/backend/implicit_step.hpp"
#include "dem/implicit/rotation_items.hpp"
#include "dem/schedule/step_arrays.hpp"

namespace scree {

// Workspace of implicit steps, kept from one to the next.
struct CudaImplicitArrays {
  StepArrays<DeviceArray> step;
  SolverProgress solver;

  // Sizes the arrays for the items and their list after it is built.
  void resize(const CudaItems& items);
};

inline constexpr int kResidualThreads = 128;

// Residual, diagonal block and norms of a particle from its entries of the Newton matrix.
template <class Residual, class Norms>
__global__ void __launch_bounds__(kResidualThreads)
    residual_kernel(Index n, const __grid_constant__ Residual residual, const __grid_constant__ Norms of,
                    FrictionNorms* largest) {
  const Index i = thread_index();
  FrictionNorms norms{};
  if (i < n) {
    residual(i);
    norms = of(i);
  }
  block_max(norms.residual, &largest->residual);
  block_max(norms.correction_bound, &largest->correction_bound);
  block_max(norms.force, &largest->force);
  block_max(norms.stiffness_ratio, &largest->stiffness_ratio);
  block_max(norms.phase_squared, &largest->phase_squared);
}

// Whether the item's value is the largest of all particles.
template <class Item>
struct IsLargest {
  Item of;
  const Real* largest;
  __device__ bool operator()(Index i) const { return of(i) == *largest; }
};

// See `ImplicitSchedule` for the functions. Ghosts are refreshed by the next pass that reads them, so that
// the exchange overlaps with rows that need none.
class CudaImplicitOperations {
 public:
  using Rows = SlicedRows;
  using Arrays = StepArrays<DeviceArray>;

  CudaImplicitOperations(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays, Real h);

  CudaItems& items() { return items_; }
  ParticleArrays& now() { return items_.now; }
  SecondArrays& start() { return items_.other; }
  Arrays& arrays() { return arrays_.step; }
  Real h() const { return h_; }
  DeviceViews views() { return items_.views(); }
  SlicedRows rows() const { return items_.list.rows(); }
  const Index* surface_offsets() const { return items_.surfaces.list().offsets; }
  const Index* surface_entries() const { return items_.surfaces.list().surfaces; }
  SurfaceMoves surface_moves() { return bodies_.upload_moves(); }
  HostSurfaces& side() { return bodies_.side(); }
  bool has_surfaces() const { return bodies_.have_surfaces(); }

  template <class Item>
  void for_each(const Item& item) {
    scree::for_each(items_.device(), items_.owned, item);
  }
  template <class Item>
  Real max(const Item& item) {
    max_over(items_.device(), items_.owned, item, items_.results.at(&Results::largest));
    return items_.ranks.max(items_.results.fetch(&Results::largest));
  }
  template <class Item>
  void queue_max(const Item& item) {
    max_over(items_.device(), items_.owned, item, items_.results.at(&Results::largest));
    max_is_queued_ = true;
  }
  Real queued_max() {
    wait_for_queued();
    return items_.ranks.max(items_.results.host().largest);
  }
  template <class Item>
  void queue_sum(const Item& item) {
    items_.queue_sums(item, &Results::slope);
    sum_is_queued_ = true;
  }
  Real queued_sum() {
    wait_for_queued();
    return items_.results.totals(items_.results.host().slope)[0];
  }
  Real largest_displacement();
  void copy(const DeviceArray<Vec3>& from, DeviceArray<Vec3>& to) {
    copy_async(to.data(), from.data(), from.size(), items_.stream);
  }

  void iterate_changed() { ghosts_stale_ = true; }
  void find_surface_steps(const FrictionStart& start) { bodies_.find_steps(start); }
  void take_surface_steps() { bodies_.take_steps(h_); }
  template <class Residual, class Norms>
  void form_system(const StepSystem& system, const Residual& residual, const Norms& norms);
  FrictionNorms norms();
  template <class System>
  int solve(System& of, Real largest_stiffness_ratio, Real tolerance) {
    return solve_on_device(items_, arrays_.solver, of, largest_stiffness_ratio, tolerance);
  }
  void lag_limits(const FrictionStart& start);
  void account_contacts(const FrictionStart& start);
  template <class Item>
  GlobalId worst(const Item& item);
  void report_not_finite() { items_.report_not_finite(arrays().residual.data()); }
  void undo();

 private:
  // Queues a pass over the rows, queue_rows(device, first, end), after a refresh of the ghosts where the
  // iterate has changed.
  template <class QueueRows>
  void queue_with_ghosts(const QueueRows& queue_rows, HaloClock* clock);
  void refresh_ghosts(Device on);
  // Queues the copy of a queued maximum and sum to the host, which a wait must follow: between kernels a copy
  // would delay the second one.
  void copy_queued();
  void wait_for_queued();

  CudaItems& items_;
  CudaBodies& bodies_;
  CudaImplicitArrays& arrays_;
  const Real h_;
  bool ghosts_stale_ = false;
  bool max_is_queued_ = false, sum_is_queued_ = false;
};

template <class QueueRows>
void CudaImplicitOperations::queue_with_ghosts(const QueueRows& queue_rows, HaloClock* clock) {
  if (!ghosts_stale_) return queue_rows(items_.device(), 0, items_.owned);
  items_.halo_after_rows();
  items_.queue_overlapping_halo([&](Device on) { refresh_ghosts(on); }, queue_rows, clock);
  items_.rows_after_halo();
  ghosts_stale_ = false;
}

// Without rotation, one kernel computes the system, the residual and the norms.
template <class Residual, class Norms>
void CudaImplicitOperations::form_system(const StepSystem& system, const Residual& residual,
                                         const Norms& norms) {
  constexpr bool kInOneKernel = std::is_same_v<Residual, ResidualItem>;
  FrictionNorms* largest = items_.results.at(&Results::norms);
  require_cuda(cudaMemsetAsync(largest, 0, sizeof(FrictionNorms), items_.stream), "cudaMemsetAsync");
  DeviceStepSystem r{items_.views(), 0, 0, system, {}, {}, largest};
  if constexpr (kInOneKernel) r.residual = residual, r.norms = norms;
  queue_with_ghosts(
      [&](Device on, Index first, Index end) {
        r.first = first, r.end = end;
        items_.kernels->system(on, r);
      },
      &items_.halo_stream.clock);
  if constexpr (!kInOneKernel) {
    if (items_.owned == 0) return;
    residual_kernel<<<blocks_for(items_.owned, kResidualThreads), kResidualThreads, 0, items_.stream>>>(
        items_.owned, residual, norms, largest);
    require_cuda(cudaGetLastError(), "residual");
  }
}

template <class Item>
GlobalId CudaImplicitOperations::worst(const Item& item) {
  Real* largest = items_.results.at(&Results::largest);
  max_over(items_.device(), items_.owned, item, largest);
  items_.halo_stream.halo.max(items_.device(), largest, 1);
  const long long worst = items_.smallest_id(IsLargest<Item>{item, largest});
  return worst < kNoId ? worst : -1;
}

std::unique_ptr<ImplicitStep> open_cuda_step(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays,
                                             Real h);

}  // namespace scree
