// Explicit steps of one law as kernels.
#pragma once

#include "contact_kernels.cuh"
#include "for_each.cuh"
#include "staging.cuh"
#include "warp_rows.cuh"

namespace scree {

// Sets the number of the step before the open one, which the contact history is read by.
template <class Laws, class Views, class Request>
__device__ Views at_open_step(Views views, const Request& r) {
  if constexpr (ContactWalk<Laws, decltype(views.rows)>::Law::kHistory > 0)
    views.history.step = *r.first_step + r.control->closed;
  return views;
}

// Called by the last block of a step.
__device__ inline void close_step(VerletControl& c) {
  const Real largest = __uint_as_float(c.largest);
  c.largest = 0;
  if (c.alone)
    c.close(largest);
  else
    c.shared[0] = largest, c.shared[1] = c.outside;
}

// Whether the particle's new position is outside the domain. Far from its faces the old position alone rules
// that out.
__device__ inline bool is_outside(const VerletRequest& r, Index i, Vec4 old_position, Vec4 new_position,
                                  Real d_squared) {
  const Real margin = r.control->half_skin;
  if (d_squared < margin * margin && r.box.inside(xyz(old_position), margin)) return false;
  return !r.box.inside(xyz(new_position)) && !r.drifting[i];
}

__device__ inline bool is_outside(const MixedRequest& r, Index i, int parity, Real d_squared) {
  const MixedFraction part = r.state.fraction[i];
  const Real margin = r.control->half_skin;
  if (!part.near_open_side && !(d_squared > margin * margin)) return false;
  const FixedPointPosition fixed_position = (parity == 0 ? r.state.position[1] : r.state.position[0])[i];
  return !r.drifting[i] && !r.box.inside(mixed_position(r.grid, r.in.position[i], fixed_position, part));
}

// Entries of a row that a launch of few threads evaluates at once.
inline constexpr int kFewThreadsAtOnce = 4;
// Blocks per multiprocessor, which bounds the registers per thread: latency is hidden by many threads or,
// with entries evaluated at once, by their independent loads.
constexpr int verlet_blocks(int at_once) { return at_once == 0 ? 7 : 4; }
constexpr int mixed_blocks(int at_once) { return at_once == 0 ? 10 : 6; }

// Programmatic dependent launch: blocks of the next step may start from now on, and this one waits until the
// previous step is done.
__device__ inline void await_step_before() {
#if __CUDA_ARCH__ >= 900
  cudaTriggerProgrammaticLaunchCompletion();
  cudaGridDependencySynchronize();
#endif
}

// A block's part in the largest displacement of a step.
struct BlockLargest {
  unsigned largest, arrived;
  __device__ void clear() {
    if (threadIdx.x == 0) largest = arrived = 0;
    __syncthreads();
  }
};

// Every thread calls this at its end: the last block of the step closes it. d_squared: squared displacement
// of the thread's particle, 0 for one outside the search [m^2].
__device__ inline void close_by_last_block(BlockLargest& block, Real d_squared, unsigned step_blocks,
                                           VerletControl& control) {
  __syncwarp();  // lane 0 acts for all: __syncwarp makes their writes visible to it
  // Rounding up to float keeps the order of the doubles, and a NaN stays the largest.
  const unsigned bits = __float_as_uint(__double2float_ru(d_squared)) & 0x7fffffffu;
  const unsigned warp_largest = __reduce_max_sync(~0u, bits);
  if (threadIdx.x % warpSize > 0) return;
  // The last warp to arrive acts for the block; the others do not wait for it.
  atomicMax(&block.largest, warp_largest);
  __threadfence_block();
  if (atomicAdd(&block.arrived, 1u) != kStepBlock / warpSize - 1) return;
  __threadfence_block();
  const unsigned largest = atomicMax(&block.largest, 0u);
  atomicMax(&control.largest, largest);
  if (is_last_block(&control.finished_blocks, step_blocks)) close_step(control);
}

using VerletStage = WarpStage<sizeof(Vec4), kStepBlock>;

template <int kAtOnce, class Laws>
__global__ void __launch_bounds__(kStepBlock, verlet_blocks(kAtOnce))
    verlet_advance_kernel(const __grid_constant__ VerletRequest r, const Laws laws) {
  await_step_before();
  if (r.control->stop) return;
  const int p = r.control->parity[0], v = r.control->parity[1];
  __shared__ VerletStage::Shared shared;
  __shared__ BlockLargest largest_of_step;
  largest_of_step.clear();
  const Index i = r.rows.particle(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const VerletStage stage(shared, first, min(static_cast<Index>(warpSize), r.rows.end - first));
  Vec3* const acceleration = stage.load(r.state.acceleration);
  VerletAdvanceItem<Laws, PrunedRows<kAtOnce>> item{
      {explicit_walk(at_open_step<Laws>(views_for<kAtOnce>(r.in, r.control->rows, r.control->margin), r),
                     laws, r.state.h),
       r.gravity, nullptr, nullptr, nullptr},
      r.state};
  item.forces.walk.in.position = p == 0 ? r.position[0] : r.position[1];
  item.forces.walk.in.velocity = v == 0 ? r.velocity[0] : r.velocity[1];
  Vec4 position, velocity;
  item.state.position = only(position, i), item.state.velocity = only(velocity, i);
  item.state.acceleration = acceleration;
  typename decltype(item)::Total force;
  if (i < r.rows.end) force = item.forces.total(i);
  stage.await();
  Real d_squared = 0;
  if (i < r.rows.end) {
    d_squared = item.advance(i, force);
    if (is_outside(r, i, item.forces.walk.in.position[i], position, d_squared)) r.control->outside = 1;
  }
  stage.store(r.state.acceleration);
  stage.put(position, p == 0 ? r.position[1] : r.position[0]);
  stage.put(velocity, v == 0 ? r.velocity[1] : r.velocity[0]);

  close_by_last_block(largest_of_step, i < r.active ? d_squared : 0, r.rows.step_blocks, *r.control);
}

// Number of words of the result of a contact: force, torque, loss, and the loss by kind.
template <class Laws>
inline constexpr int kWordsOf = 7 + kLossKindsOf<LawOf<Laws>>;
template <class Word, class Laws>
using WarpContactsOf = WarpContacts<Word, kWordsOf<Laws>>;
template <class Word, class Laws>
using WarpRowsOf = WarpRows<Word, kWordsOf<Laws>>;

// Blocks per multiprocessor: registers are limited so that the evaluation of a contact does not spill.
// Rolling resistance needs more of them: fewer warps cost less than spilled registers, which take the place
// of neighbours in the L1 cache.
template <class Laws>
inline constexpr int kFrictionBlocks = LawOf<Laws>::Rolling::acts ? 3 : 4;

// The same for laws with `kNeedsMotion`: the lanes of a warp share its contacts.
template <class Laws>
__global__ void __launch_bounds__(kStepBlock, kFrictionBlocks<Laws>)
    friction_advance_kernel(const __grid_constant__ VerletRequest r, const Laws laws) {
  await_step_before();
  if (r.control->stop) return;
  const int p = r.control->parity[0], v = r.control->parity[1];
  __shared__ union {
    WarpContactsOf<double, Laws> contacts;
    alignas(16) unsigned char stage[kSlice * sizeof(Vec4)];
  } shared[kStepBlock / kSlice];  // one per warp
  __shared__ BlockLargest largest_of_step;
  largest_of_step.clear();
  const Index i = r.rows.particle(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const bool idle = i >= r.rows.end;
  auto& warp_shared = shared[threadIdx.x / kSlice];
  const auto views = at_open_step<Laws>(
      warp_views(r.in, r.control->rows, r.control->margin, &warp_shared.contacts, idle), r);
  VerletAdvanceItem<Laws, WarpRowsOf<double, Laws>> item{
      {explicit_walk(views, laws, r.state.h), r.gravity, nullptr, nullptr, nullptr}, r.state};
  item.forces.walk.in.position = p == 0 ? r.position[0] : r.position[1];
  item.forces.walk.in.velocity = v == 0 ? r.velocity[0] : r.velocity[1];
  item.forces.walk.in.spin = v == 0 ? r.spin[0] : r.spin[1];
  typename decltype(item)::Total force;
  if (first < r.rows.end) {
    auto self = item.forces.walk.self(idle ? r.rows.end - 1 : i);
    self.i = i;
    force = item.forces.weight(self);
    item.forces.add_neighbors(self, force);
  }
  if (!idle) item.forces.add_surfaces(item.forces.walk.self(i), force);
  Vec4 position, velocity, spin;
  Quaternion orientation;
  item.state.position = only(position, i), item.state.velocity = only(velocity, i);
  item.state.spin = only(spin, i), item.state.orientation = only(orientation, i);
  Real d_squared = 0;
  if (!idle) {
    orientation = r.state.orientation[i];
    d_squared = item.advance(i, force);
    if (is_outside(r, i, item.forces.walk.in.position[i], position, d_squared)) r.control->outside = 1;
  }
  __syncwarp();
  const VerletStage stage(warp_shared.stage, first, min(static_cast<Index>(warpSize), r.rows.end - first));
  stage.put(position, p == 0 ? r.position[1] : r.position[0]);
  stage.put(velocity, v == 0 ? r.velocity[1] : r.velocity[0]);
  stage.put(spin, v == 0 ? r.spin[1] : r.spin[0]);
  stage.put(orientation, r.state.orientation);

  close_by_last_block(largest_of_step, i < r.active ? d_squared : 0, r.rows.step_blocks, *r.control);
}

template <int kAtOnce, class Laws>
__global__ void __launch_bounds__(kStepBlock, mixed_blocks(kAtOnce))
    mixed_advance_kernel(const __grid_constant__ MixedRequest r, const Laws laws) {
  await_step_before();
  if (r.control->stop) return;
  const int parity = r.control->parity[0];
  __shared__ BlockLargest largest_of_step;
  largest_of_step.clear();
  const Index i = r.rows.particle();
  Real d_squared = 0;
  if (i < r.rows.end) {
    const MixedAdvanceItem<Laws, PrunedRows<kAtOnce>> item{
        at_open_step<Laws>(views_for<kAtOnce>(r.in, r.control->rows, r.control->margin), r),
        laws,
        r.gravity,
        r.state,
        parity,
        r.grid,
        r.h};
    d_squared = item(i);
    if (is_outside(r, i, parity, d_squared)) r.control->outside = 1;
  }
  close_by_last_block(largest_of_step, i < r.active ? d_squared : 0, r.rows.step_blocks, *r.control);
}

template <class Laws>
using MixedFrictionItemOf = MixedFrictionItem<Laws, WarpRowsOf<float, Laws>>;

template <class Laws>
__device__ inline MixedFrictionItemOf<Laws> mixed_friction_item(const MixedRequest& r, const Laws& laws,
                                                                WarpContactsOf<float, Laws>* contacts,
                                                                bool idle) {
  const int parity = r.control->parity[0];
  const auto views =
      at_open_step<Laws>(warp_views(r.in, r.control->rows, r.control->margin, contacts, idle), r);
  const FixedPointPosition* fixed_position = parity == 0 ? r.state.position[0] : r.state.position[1];
  const MixedMotion* motion = parity == 0 ? r.state.motion[0] : r.state.motion[1];
  const MixedSpin* spin = parity == 0 ? r.state.spin[0] : r.state.spin[1];
  return {{views, laws, {{fixed_position, motion, r.state.fraction, r.grid}, spin, r.h}},
          r.gravity,
          r.state,
          r.orientation,
          parity,
          r.rolling_loss,
          r.twisting_loss};
}

// Adds the contacts with walls to `force`. They are in double precision; with rolling resistance inlined code
// would make the kernel spill registers also where it evaluates pairs of particles.
template <class Laws>
__device__ __noinline__ auto with_walls(const MixedRequest& r, const Laws laws, Index i,
                                        typename MixedFrictionItemOf<Laws>::Total force) {
  const auto item = mixed_friction_item(r, laws, nullptr, false);
  item.add_surfaces(item.walk.self(i), force);
  return force;
}

template <class Laws>
inline constexpr int kMixedFrictionBlocks = LawOf<Laws>::Rolling::acts ? 4 : 5;

template <class Laws>
__global__ void __launch_bounds__(kStepBlock, kMixedFrictionBlocks<Laws>)
    mixed_friction_kernel(const __grid_constant__ MixedRequest r, const Laws laws) {
  await_step_before();
  if (r.control->stop) return;
  __shared__ WarpContactsOf<float, Laws> contacts[kStepBlock / kSlice];
  __shared__ BlockLargest largest_of_step;
  largest_of_step.clear();
  const Index i = r.rows.particle(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const bool idle = i >= r.rows.end;
  const auto item = mixed_friction_item(r, laws, &contacts[threadIdx.x / kSlice], idle);
  typename MixedFrictionItemOf<Laws>::Total force;
  if (first < r.rows.end) {
    auto self = item.walk.self(idle ? r.rows.end - 1 : i);
    self.i = i;
    force = item.weight(self);
    item.add_neighbors(self, force);
  }
  Real d_squared = 0;
  if (!idle) {
    const auto self = item.walk.self(i);
    if constexpr (LawOf<Laws>::Rolling::acts) {
      if (r.in.surface_offsets[i] < r.in.surface_offsets[i + 1]) force = with_walls(r, laws, i, force);
    } else {
      item.add_surfaces(self, force);
    }
    d_squared = item.advance(self, force);
    if (is_outside(r, i, item.parity, d_squared)) r.control->outside = 1;
  }
  close_by_last_block(largest_of_step, i < r.active ? d_squared : 0, r.rows.step_blocks, *r.control);
}

template <class Laws>
__global__ void verlet_finish_kernel(const __grid_constant__ VerletRequest r, const Laws laws,
                                     Real* largest) {
  const int p = r.control->parity[0], v = r.control->parity[1];
  const Index i = thread_index();
  Real a_squared = 0;
  if (i < r.rows.end) {
    VerletFinishItem<Laws, PrunedRows<0>> item{
        {explicit_walk(at_open_step<Laws>(views_for<0>(r.in, RowUse::all, 0), r), laws, r.state.h), r.gravity,
         r.force, r.state.loss_power, r.state.angular_acceleration},
        r.state};
    item.forces.walk.in.position = r.position[p], item.forces.walk.in.velocity = r.velocity[v];
    item.state.position = r.position[p], item.state.velocity = r.velocity[1 - v];
    a_squared = item(i);
  }
  block_max(a_squared, largest);
}

// The same for laws with `kNeedsMotion`: the lanes of a warp share its contacts.
template <class Laws>
__global__ void __launch_bounds__(kStepBlock, kFrictionBlocks<Laws>)
    friction_finish_kernel(const __grid_constant__ VerletRequest r, const Laws laws, Real* largest) {
  const int p = r.control->parity[0], v = r.control->parity[1];
  __shared__ WarpContactsOf<double, Laws> contacts[kStepBlock / kSlice];
  const Index i = thread_index(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const bool idle = i >= r.rows.end;
  VerletFinishItem<Laws, WarpRowsOf<double, Laws>> item{
      {explicit_walk(
           at_open_step<Laws>(warp_views(r.in, RowUse::all, 0, &contacts[threadIdx.x / kSlice], idle), r),
           laws, r.state.h),
       r.gravity, r.force, r.state.loss_power, r.state.angular_acceleration},
      r.state};
  auto& in = item.forces.walk.in;
  in.position = p == 0 ? r.position[0] : r.position[1];
  in.velocity = v == 0 ? r.velocity[0] : r.velocity[1];
  in.spin = v == 0 ? r.spin[0] : r.spin[1];
  item.state.velocity = v == 0 ? r.velocity[1] : r.velocity[0];
  item.state.spin = v == 0 ? r.spin[1] : r.spin[0];
  typename decltype(item)::Total force;
  if (first < r.rows.end) {
    auto self = item.forces.walk.self(idle ? r.rows.end - 1 : i);
    self.i = i;
    force = item.forces.weight(self);
    item.forces.add_neighbors(self, force);
  }
  Real a_squared = 0;
  if (!idle) {
    item.forces.add_surfaces(item.forces.walk.self(i), force);
    a_squared = item.finish(i, force);
  }
  block_max(a_squared, largest);
}

}  // namespace scree
