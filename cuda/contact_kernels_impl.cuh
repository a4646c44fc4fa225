// The contact stages of one law as kernels; included where they are compiled, one source file per elastic law.
#pragma once

#include "contact_kernels.cuh"
#include "for_each.cuh"

namespace scree {

// Force, Newton matrix and residual of a particle in one pass.
template <class Elastic, class Laws>
struct SystemItem {
  ContactSystemItem<Elastic, Laws, SlicedRows> system;
  ResidualItem residual;
  StepNormsItem norms;

  SCREE_HD StepNorms operator()(Index i) const {
    system(i);
    residual(i);
    return norms(i);
  }
};

template <class Item>
__global__ void system_kernel(Index n, const __grid_constant__ Item item, StepNorms* largest) {
  const Index i = thread_index();
  StepNorms norms{};
  if (i < n) norms = item(i);
  block_max(norms.residual, &largest->residual);
  block_max(norms.correction_bound, &largest->correction_bound);
  block_max(norms.force, &largest->force);
  block_max(norms.stiffening, &largest->stiffening);
}

// Called by the last block of a step: the step is closed and the next one open.
__device__ inline void close_step(VerletControl& c) {
  // Other blocks wrote these two: not to be read from this multiprocessor's cache.
  const unsigned largest = *static_cast<volatile unsigned*>(&c.largest);
  const bool outside = *static_cast<volatile int*>(&c.outside) != 0;
  c.bound += std::sqrt(static_cast<Real>(__uint_as_float(largest)));
  c.largest = c.finished_blocks = 0;
  ++c.closed;
  c.parity[0] ^= 1, c.parity[1] ^= 1;
  c.judge(outside);
}

// Whether the particle's new place is outside. Far from the sides the old place alone says no.
__device__ inline bool is_outside(const VerletRequest& r, Index i, Vec4 old_place, const Vec4* new_place,
                                  Real d_squared) {
  const Real margin = r.control->half_skin;
  if (d_squared < margin * margin && r.box.inside(xyz(old_place), margin)) return false;
  return !r.box.inside(xyz(new_place[i])) && !r.drifting[i];
}

inline constexpr int kVerletThreads = 128;

template <class Elastic, class Laws>
__global__ void __launch_bounds__(kVerletThreads)
    verlet_advance_kernel(const __grid_constant__ VerletRequest r, const Laws laws) {
  if (r.control->stop) return;
  const int p = r.control->parity[0], v = r.control->parity[1];
  __shared__ unsigned largest;
  if (threadIdx.x == 0) largest = 0;
  __syncthreads();
  const Index i = thread_index();
  Real d_squared = 0;
  if (i < r.n) {
    VerletAdvanceItem<Elastic, Laws, SlicedRows> item{{r.in, laws, r.gravity, nullptr, nullptr}, r.state};
    item.contacts.in.position = p == 0 ? r.position[0] : r.position[1];
    item.contacts.in.velocity = v == 0 ? r.velocity[0] : r.velocity[1];
    item.state.position = p == 0 ? r.position[1] : r.position[0];
    item.state.velocity = v == 0 ? r.velocity[1] : r.velocity[0];
    d_squared = item(i);
    if (is_outside(r, i, item.contacts.in.position[i], item.state.position, d_squared)) r.control->outside = 1;
  }
  // Singles that round up keep the order of the doubles, and a NaN stays the largest.
  const unsigned bits = __float_as_uint(__double2float_ru(d_squared)) & 0x7fffffffu;
  const unsigned warp_largest = __reduce_max_sync(~0u, bits);
  if (threadIdx.x % warpSize == 0) atomicMax(&largest, warp_largest);
  __syncthreads();
  if (threadIdx.x > 0) return;
  if (largest > *static_cast<volatile unsigned*>(&r.control->largest)) atomicMax(&r.control->largest, largest);
  __threadfence();
  if (atomicAdd(&r.control->finished_blocks, 1u) == gridDim.x - 1) close_step(*r.control);
}

template <class Elastic, class Laws>
__global__ void verlet_finish_kernel(const __grid_constant__ VerletRequest r, const Laws laws, Real* largest) {
  const int p = r.control->parity[0], v = r.control->parity[1];
  const Index i = thread_index();
  Real a_squared = 0;
  if (i < r.n) {
    VerletFinishItem<Elastic, Laws, SlicedRows> item{{r.in, laws, r.gravity, r.force, r.state.loss_power}, r.state};
    item.contacts.in.position = r.position[p], item.contacts.in.velocity = r.velocity[v];
    item.state.position = r.position[p], item.state.velocity = r.velocity[1 - v];
    a_squared = item(i);
  }
  block_max(a_squared, largest);
}

template <class Elastic, class Laws>
class ContactKernelsOf : public DeviceContactKernels {
 public:
  explicit ContactKernelsOf(Laws laws) : laws_(laws) {}

  void forces(Device device, const DeviceViews& in, Vec3 gravity, Index n, Vec3* force,
              Real* loss_power) const override {
    for_each(device, n, ContactForceItem<Elastic, Laws, SlicedRows>{in, laws_, gravity, force, loss_power});
  }
  void system(Device device, const SystemRequest& r) const override {
    require_cuda(cudaMemsetAsync(r.largest, 0, sizeof(StepNorms), device.stream), "system");
    if (r.n == 0) return;
    const SystemItem<Elastic, Laws> item{
        {{r.in, laws_, r.start}, r.gravity, r.weights, r.forces, r.matrix},
        {r.step, r.forces.step_force, r.matrix, r.residual, r.inverse_block, r.stiffening},
        {r.step, r.residual, r.forces.magnitude, r.stiffening}};
    system_kernel<<<blocks_for(r.n), kThreadsPerBlock, 0, device.stream>>>(r.n, item, r.largest);
    require_cuda(cudaGetLastError(), "system");
  }
  void shapes(Device device, const DeviceViews& in, Index n, const StepStart& start,
              ShapeContact* out) const override {
    for_each(device, n, ShapeStepItem<Elastic, Laws, SlicedRows>{{in, laws_, start}, out});
  }
  void shapes(Device device, const DeviceViews& in, const ShapePlaces& places, Index n,
              ShapeContact* out) const override {
    for_each(device, n, ShapeContactItem<Elastic, Laws, SlicedRows>{in, places, laws_, out});
  }
  void energies(Device device, const DeviceViews& in, Index n, const EnergyOutputs& out) const override {
    for_each(device, n,
             ContactEnergyItem<Elastic, Laws, SlicedRows>{in, laws_, out.energy, out.contacts, out.pairs});
  }
  void verlet_advance(Device device, const VerletRequest& r) const override {
    verlet_advance_kernel<Elastic>
        <<<std::max(1u, blocks_for(r.n, kVerletThreads)), kVerletThreads, 0, device.stream>>>(r, laws_);
    require_cuda(cudaGetLastError(), "explicit step");
  }
  void verlet_finish(Device device, const VerletRequest& r, Real* largest) const override {
    require_cuda(cudaMemsetAsync(largest, 0, sizeof(Real), device.stream), "explicit step");
    if (r.n == 0) return;
    verlet_finish_kernel<Elastic><<<blocks_for(r.n), kThreadsPerBlock, 0, device.stream>>>(r, laws_, largest);
    require_cuda(cudaGetLastError(), "explicit step");
  }

 private:
  Laws laws_;
};

template <class Elastic>
std::unique_ptr<DeviceContactKernels> kernels_with(const Contact& contact, const KelvinVoigt* d_laws) {
  if (contact.laws.size() == 1) return std::make_unique<ContactKernelsOf<Elastic, OneLaw>>(OneLaw{contact.laws[0]});
  return std::make_unique<ContactKernelsOf<Elastic, LawTable>>(LawTable{d_laws, contact.materials()});
}

}  // namespace scree
