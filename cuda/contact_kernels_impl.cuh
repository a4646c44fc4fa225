// The contact stages of one law as kernels; included where they are compiled, one source file per elastic
// law.
#pragma once

#include <stdexcept>

#include "contact_kernels.cuh"
#include "for_each.cuh"
#include "staging.cuh"
#include "warp_rows.cuh"

namespace scree {

// Force, Newton matrix and residual of a particle in one pass.
template <class Laws>
struct SystemItem {
  ContactSystemItem<Laws, SlicedRows> system;
  ResidualItem residual;
  StepNormsItem norms;

  SCREE_HD StepNorms operator()(Index i) const {
    system(i);
    residual(i);
    return norms(i);
  }
};

inline constexpr int kSystemThreads = 128;

using SystemStage = WarpStage<sizeof(Sym3), kSystemThreads>;

template <class Laws>
__global__ void __launch_bounds__(kSystemThreads)
    system_kernel(const __grid_constant__ SystemRequest r, const Laws laws) {
  __shared__ SystemStage::Shared shared;
  const Index i = r.first + thread_index(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const SystemStage stage(shared, first, min(static_cast<Index>(warpSize), r.end - first));
  Vec3 step_force, end_force, residual;
  Sym3 diagonal, inverse_block;
  StepNorms norms{};
  if (i < r.end) {
    SystemItem<Laws> item{{{r.in, laws, {r.start}}, r.gravity, r.weights, r.forces, r.matrix},
                          {r.step, r.forces.step_force, r.matrix, r.residual, r.inverse_block, r.stiffening},
                          {r.step, r.residual, r.forces.magnitude, r.stiffening}};
    item.system.out.step_force = only(step_force, i), item.residual.force = only(step_force, i);
    item.system.out.end_force = only(end_force, i);
    item.system.matrix.diagonal = item.residual.matrix.diagonal = only(diagonal, i);
    item.residual.residual = only(residual, i), item.norms.residual = only(residual, i);
    item.residual.inverse_block = only(inverse_block, i);
    norms = item(i);
  }
  stage.put(step_force, r.forces.step_force), stage.put(end_force, r.forces.end_force);
  stage.put(diagonal, r.matrix.diagonal);
  stage.put(residual, r.residual), stage.put(inverse_block, r.inverse_block);
  block_max(norms.residual, &r.largest->residual);
  block_max(norms.correction_bound, &r.largest->correction_bound);
  block_max(norms.force, &r.largest->force);
  block_max(norms.stiffening, &r.largest->stiffening);
}

// Forces, torques and entries of the Newton matrix; what else a particle has in the solve, items find that
// read the entries. The walk needs the registers by itself.
template <class Laws>
__global__ void __launch_bounds__(kSystemThreads)
    rubbing_kernel(const __grid_constant__ DeviceRubbingRequest r, const Laws laws) {
  const Index i = r.first + thread_index();
  if (i >= r.end) return;
  const RubbingRequest& of = r.of;
  RubbingSystemItem<Laws, SlicedRows>{
      {r.in, laws, {of.start}}, of.gravity, of.weights, of.forces, of.torques, of.matrix, of.sharpness}(i);
}

// With the number of the step before the open one, for what contacts remember.
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

// Whether the particle's new place is outside. Far from the sides the old place alone says no.
__device__ inline bool is_outside(const VerletRequest& r, Index i, Vec4 old_place, Vec4 new_place,
                                  Real d_squared) {
  const Real margin = r.control->half_skin;
  if (d_squared < margin * margin && r.box.inside(xyz(old_place), margin)) return false;
  return !r.box.inside(xyz(new_place)) && !r.drifting[i];
}

__device__ inline bool is_outside(const MixedRequest& r, Index i, int parity, Real d_squared) {
  const MixedFraction part = r.state.fraction[i];
  const Real margin = r.control->half_skin;
  if (!part.near_side && !(d_squared > margin * margin)) return false;
  const MixedPlace place = (parity == 0 ? r.state.place[1] : r.state.place[0])[i];
  return !r.drifting[i] && !r.box.inside(mixed_position(r.grid, r.in.position[i], place, part));
}

// Entries of a row that a launch of few threads evaluates at once.
inline constexpr int kFewThreadsAtOnce = 4;
// Registers are rationed for so many blocks on a multiprocessor: the kernels live from many threads that
// wait, or from many entries at once.
constexpr int verlet_blocks(int at_once) { return at_once == 0 ? 7 : 4; }
constexpr int mixed_blocks(int at_once) { return at_once == 0 ? 10 : 6; }

// Blocks of the next step may come from now on, and this one waits until the step before is done.
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

// Every thread calls this at its end: the last block of the step closes it. d_squared: of the thread's
// particle, 0 for one outside the search.
__device__ inline void close_by_last_block(BlockLargest& block, Real d_squared, unsigned step_blocks,
                                           VerletControl& control) {
  __syncwarp();  // lane 0 speaks for all: it sees what they wrote
  // Singles that round up keep the order of the doubles, and a NaN stays the largest.
  const unsigned bits = __float_as_uint(__double2float_ru(d_squared)) & 0x7fffffffu;
  const unsigned warp_largest = __reduce_max_sync(~0u, bits);
  if (threadIdx.x % warpSize > 0) return;
  // The warp that comes last speaks for the block; the others do not wait for it.
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
  const Index i = r.rows.first + thread_index(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
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
  TotalForce force;
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

// Registers for so many blocks: what a contact takes must not spill.
inline constexpr int kRubbingBlocks = 4;

// The same of laws that move: a warp's lanes share out its contacts.
template <class Laws>
__global__ void __launch_bounds__(kStepBlock, kRubbingBlocks)
    rubbing_advance_kernel(const __grid_constant__ VerletRequest r, const Laws laws) {
  await_step_before();
  if (r.control->stop) return;
  const int p = r.control->parity[0], v = r.control->parity[1];
  __shared__ union {
    WarpContacts<double> contacts;
    alignas(16) unsigned char stage[kSlice * sizeof(Vec4)];
  } shared[kStepBlock / kSlice];  // of a warp each
  __shared__ BlockLargest largest_of_step;
  largest_of_step.clear();
  const Index i = r.rows.first + thread_index(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const bool idle = i >= r.rows.end;
  auto& room = shared[threadIdx.x / kSlice];
  const auto views =
      at_open_step<Laws>(warp_views(r.in, r.control->rows, r.control->margin, &room.contacts, idle), r);
  VerletAdvanceItem<Laws, WarpRows<double>> item{
      {explicit_walk(views, laws, r.state.h), r.gravity, nullptr, nullptr, nullptr}, r.state};
  item.forces.walk.in.position = p == 0 ? r.position[0] : r.position[1];
  item.forces.walk.in.velocity = v == 0 ? r.velocity[0] : r.velocity[1];
  item.forces.walk.in.spin = v == 0 ? r.spin[0] : r.spin[1];
  TotalForce force;
  if (first < r.rows.end) {
    auto self = item.forces.walk.self(idle ? r.rows.end - 1 : i);
    self.i = i;
    force = {self.u.w * r.gravity, 0, {}};
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
  const VerletStage stage(room.stage, first, min(static_cast<Index>(warpSize), r.rows.end - first));
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
  const Index i = r.rows.first + thread_index();
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

inline constexpr int kMixedRubbingBlocks = 5;

template <class Laws>
__global__ void __launch_bounds__(kStepBlock, kMixedRubbingBlocks)
    mixed_rubbing_kernel(const __grid_constant__ MixedRequest r, const Laws laws) {
  await_step_before();
  if (r.control->stop) return;
  const int parity = r.control->parity[0];
  __shared__ WarpContacts<float> contacts[kStepBlock / kSlice];
  __shared__ BlockLargest largest_of_step;
  largest_of_step.clear();
  const Index i = r.rows.first + thread_index(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const bool idle = i >= r.rows.end;
  const auto views = at_open_step<Laws>(
      warp_views(r.in, r.control->rows, r.control->margin, &contacts[threadIdx.x / kSlice], idle), r);
  const MixedPlace* place = parity == 0 ? r.state.place[0] : r.state.place[1];
  const MixedMotion* motion = parity == 0 ? r.state.motion[0] : r.state.motion[1];
  const MixedSpin* spin = parity == 0 ? r.state.spin[0] : r.state.spin[1];
  const MixedRubbingItem<Laws, WarpRows<float>> item{
      {views, laws, {{place, motion, r.state.fraction, r.grid}, spin, r.h}},
      r.gravity,
      r.state,
      r.orientation,
      parity};
  TotalForce force;
  if (first < r.rows.end) {
    auto self = item.walk.self(idle ? r.rows.end - 1 : i);
    self.i = i;
    force = item.weight(self);
    item.add_neighbors(self, force);
  }
  Real d_squared = 0;
  if (!idle) {
    const auto self = item.walk.self(i);
    item.add_surfaces(self, force);
    d_squared = item.advance(self, force);
    if (is_outside(r, i, parity, d_squared)) r.control->outside = 1;
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
    item.forces.walk.in.spin = r.spin[v], item.state.spin = r.spin[1 - v];
    item.forces.walk.in.position = r.position[p], item.forces.walk.in.velocity = r.velocity[v];
    item.state.position = r.position[p], item.state.velocity = r.velocity[1 - v];
    a_squared = item(i);
  }
  block_max(a_squared, largest);
}

inline constexpr int kSurfaceThreads = 64;

// Contacts of a chunk, one per thread and turn, and then their sums: each thread adds one term of the
// contacts, in groups that take turns. The sums are exact, so that it does not matter which.
template <class Item, class Contact, int kTerms>
__global__ void __launch_bounds__(kSurfaceThreads)
    surface_kernel(const SurfaceChunk* chunks, const __grid_constant__ Item item, const Contact* contacts,
                   SurfaceSums<kTerms>* sums) {
  constexpr int kGroup = kTerms <= 8 ? 8 : kSurfaceThreads, kGroups = kSurfaceThreads / kGroup;
  static_assert(kTerms <= kGroup);
  __shared__ ExactSum shared[kSurfaceThreads];
  __shared__ Index count;
  const SurfaceChunk chunk = chunks[blockIdx.x];
  const int thread = static_cast<int>(threadIdx.x), term = thread % kGroup, group = thread / kGroup;
  if (thread == 0) count = 0;
  for (Index k = chunk.first + thread; k < chunk.end; k += kSurfaceThreads) item(k);
  __syncthreads();
  ExactSum sum;
  Index touching = 0;
  for (Index k = chunk.first + group; k < chunk.end; k += kGroups) {
    const Contact& contact = contacts[item.in.entries.by_surface[k]];
    if (!contact.touches) continue;
    ++touching;
    if (term < kTerms) sum.add(sum_term(contact, term));
  }
  if (term == 0) atomicAdd(&count, touching);
  shared[thread] = sum;
  __syncthreads();
  SurfaceSums<kTerms>& out = sums[blockIdx.x];
  if (thread == 0) out.surface = chunk.surface, out.contacts = count;
  if (count == 0 || group > 0 || term >= kTerms) return;
  for (int other = 1; other < kGroups; ++other) sum.add(shared[other * kGroup + term]);
  out.sum[term] = sum;
}

template <class Laws>
class ContactKernelsOf : public DeviceContactKernels {
 public:
  explicit ContactKernelsOf(Laws laws) : laws_(laws) {
    if constexpr (LawOf<Laws>::kMoves)
      prefer_cache(rubbing_advance_kernel<Laws>,
                   kRubbingBlocks * kStepBlock / kSlice * sizeof(WarpContacts<double>));
    else
      prefer_cache(verlet_advance_kernel<0, Laws>, verlet_blocks(0) * sizeof(VerletStage::Shared));
  }

  int history() const override { return ContactWalk<Laws, SlicedRows>::Law::kHistory; }
  const char* mixed_trouble() const override {
    using Law = LawOf<Laws>;
    return kReaches<Law>                     ? "particles attract each other"
           : Law::kMoves && !kHasSingle<Law> ? "contacts resist rolling"
                                             : "";
  }
  void forces(Device device, const DeviceViews& in, Vec3 gravity, Index n, Vec3* force, Real* loss_power,
              Vec3* angular_acceleration) const override {
    for_each(
        device, n,
        ContactForceItem<Laws, SlicedRows>{{in, laws_}, gravity, force, loss_power, angular_acceleration});
  }
  void system(Device device, const SystemRequest& r) const override {
    if (r.end == r.first) return;
    system_kernel<Laws>
        <<<blocks_for(r.end - r.first, kSystemThreads), kSystemThreads, 0, device.stream>>>(r, laws_);
    require_cuda(cudaGetLastError(), "system");
  }
  void surface_loads(Device device, const SurfaceViews& in, const SurfaceChunks& chunks, SurfaceLoad* loads,
                     InstantSums* sums) const override {
    launch_surfaces(device, chunks, SurfaceLoadItem<Laws>{in, laws_, loads}, loads, sums);
  }
  void surface_steps(Device device, const SurfaceViews& in, const SurfaceChunks& chunks,
                     const SurfaceStart& start, SurfaceStep* steps, StepSums* sums) const override {
    launch_surfaces(device, chunks, SurfaceStepItem<Laws>{in, start.particles, start.placed, laws_, steps},
                    steps, sums);
  }
  void wall_sums(Device device, const DeviceViews& in, Index n, const WallChoice& choice,
                 ExactSums<kWallTerms>* sums, const std::function<void(Real*)>& share) const override {
    exact_sums(device, n, WallContactItem<Laws, SlicedRows>{{in, laws_}, choice}, sums, share);
  }
  void energies(Device device, const DeviceViews& in, Index n, const EnergyOutputs& out) const override {
    for_each(device, n,
             ContactEnergyItem<Laws, SlicedRows>{{in, laws_}, out.energy, out.contacts, out.pairs});
  }
  void output(Device device, const DeviceViews& in, const OutputRequest& request) const override {
    with_contact_output(request, ContactWalk<Laws, SlicedRows>{in, laws_},
                        [&](const auto& item) { for_each(device, request.n, item); });
  }
  void books(Device device, const DeviceViews& in, Index n, const StepStart& start, Real* contact_loss,
             Real* integrator_loss) const override {
    for_each(device, n,
             ContactBooksItem<Laws, SlicedRows>{{in, laws_, {start}}, contact_loss, integrator_loss});
  }
  void rubbing_system(Device device, const DeviceRubbingRequest& r) const override {
    if constexpr (kRubs<LawOf<Laws>>) {
      if (r.end == r.first) return;
      rubbing_kernel<Laws>
          <<<blocks_for(r.end - r.first, kSystemThreads), kSystemThreads, 0, device.stream>>>(r, laws_);
      require_cuda(cudaGetLastError(), "rubbing system");
    } else {
      refuse_rubbing();
    }
  }
  void rubbing_books(Device device, const DeviceViews& in, Index n, const RubbingStart& start,
                     Real* contact_loss, Real* integrator_loss) const override {
    if constexpr (kRubs<LawOf<Laws>>)
      for_each(device, n,
               RubbingBooksItem<Laws, SlicedRows>{{in, laws_, {start}}, contact_loss, integrator_loss});
    else
      refuse_rubbing();
  }
  void freeze(Device device, const DeviceViews& in, Index n, const RubbingStart& start,
              const FrozenLimits& to) const override {
    if constexpr (kRubs<LawOf<Laws>>)
      for_each(device, n, FreezeItem<Laws, SlicedRows>{{in, laws_, {start}}, to});
    else
      refuse_rubbing();
  }
  void leavers(Device device, const DeviceViews& in, const OpenBox& box, Index n,
               Leaver* leavers) const override {
    for_each(device, n, LeaverEnergyItem<Laws, SlicedRows>{{in, laws_}, box, leavers});
  }
  void departures(Device device, const DeviceViews& in, Vec3 gravity, const OpenBox& box, Index n,
                  const StartViews& start) const override {
    for_each(device, n, DepartureItem<Laws, SlicedRows>{{in, laws_}, gravity, box, start});
  }
  void verlet_advance(Device device, const VerletRequest& r) const override {
    if constexpr (LawOf<Laws>::kMoves) {
      launch(device, r, rubbing_advance_kernel<Laws>);
    } else {
      const bool eagerly = several_at_once(r.rows, verlet_blocks(kFewThreadsAtOnce));
      launch(device, r,
             eagerly ? verlet_advance_kernel<kFewThreadsAtOnce, Laws> : verlet_advance_kernel<0, Laws>);
    }
  }
  void mixed_advance(Device device, const MixedRequest& r) const override {
    if constexpr (!LawOf<Laws>::kMoves && !kReaches<LawOf<Laws>>)
      advance_in_mixed(device, r);
    else if constexpr (kHasSingle<LawOf<Laws>>)
      launch(device, r, mixed_rubbing_kernel<Laws>);
    else
      throw std::logic_error("mixed_advance: this law is computed in double precision");
  }
  void verlet_finish(Device device, const VerletRequest& r, Real* largest) const override {
    require_cuda(cudaMemsetAsync(largest, 0, sizeof(Real), device.stream), "explicit step");
    if (r.rows.end == 0) return;
    verlet_finish_kernel<Laws>
        <<<blocks_for(r.rows.end), launches().block, 0, device.stream>>>(r, laws_, largest);
    require_cuda(cudaGetLastError(), "explicit step");
  }

 private:
  [[noreturn]] static void refuse_rubbing() {
    throw std::logic_error("ContactKernelsOf: the law has no implicit steps with friction");
  }
  // Whether so many particles have room side by side on the GPU, with so many blocks on a multiprocessor.
  bool several_at_once(const StepRows& rows, int blocks) const {
    const bool fits = step_blocks(rows.first, rows.end) <= multiprocessors_ * static_cast<unsigned>(blocks);
    return launches().several_at_once.value_or(fits);
  }
  void advance_in_mixed(Device device, const MixedRequest& r) const {
    const bool eagerly = several_at_once(r.rows, mixed_blocks(kFewThreadsAtOnce));
    launch(device, r,
           eagerly ? mixed_advance_kernel<kFewThreadsAtOnce, Laws> : mixed_advance_kernel<0, Laws>);
  }
  template <class Request>
  void launch(Device device, const Request& r, void (*kernel)(Request, Laws)) const {
    // The blocks of a step come while those of the step before leave.
    cudaLaunchAttribute overlap{};
    overlap.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    overlap.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t config{};
    config.gridDim = step_blocks(r.rows.first, r.rows.end), config.blockDim = kStepBlock;
    config.stream = device.stream, config.attrs = &overlap,
    config.numAttrs = overlaps_ && r.rows.follows ? 1 : 0;
    require_cuda(cudaLaunchKernelEx(&config, kernel, r, laws_), "explicit step");
  }

  template <class Item, class Contact, int kTerms>
  void launch_surfaces(Device device, const SurfaceChunks& chunks, const Item& item, const Contact* contacts,
                       SurfaceSums<kTerms>* sums) const {
    if (chunks.count == 0) return;
    surface_kernel<<<static_cast<unsigned>(chunks.count), kSurfaceThreads, 0, device.stream>>>(
        chunks.chunks, item, contacts, sums);
    require_cuda(cudaGetLastError(), "contacts with bodies");
  }

  Laws laws_;
  // Kernels compiled for older generations do not wait for the step before.
  bool overlaps_ = generation_of(verlet_finish_kernel<Laws>) >= 90;
  unsigned multiprocessors_ = static_cast<unsigned>(multiprocessors());
};

// With the table that the kernels of several laws refer to.
template <class Law>
class TableKernels : public ContactKernelsOf<LawTable<Law>> {
 public:
  TableKernels(DeviceArray<Law> table, int materials)
      : ContactKernelsOf<LawTable<Law>>({table.data(), materials}), table_(std::move(table)) {}

 private:
  DeviceArray<Law> table_;
};

template <class Law>
std::unique_ptr<DeviceContactKernels> device_kernels(const std::vector<Law>& laws, int materials) {
  if (laws.size() == 1) return std::make_unique<ContactKernelsOf<OneLaw<Law>>>(OneLaw<Law>{laws[0]});
  DeviceArray<Law> table;
  table.upload(laws, nullptr);
  return std::make_unique<TableKernels<Law>>(std::move(table), materials);
}

}  // namespace scree
