// The contact stages of one law as kernels, for the source files that instantiate them: one per law.
#pragma once

#include <stdexcept>

#include "contact_kernels.cuh"
#include "explicit_kernels.cuh"
#include "for_each.cuh"
#include "staging.cuh"
#include "surface_kernels.cuh"

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
    system_kernel(const __grid_constant__ DeviceStepSystem r, const Laws laws) {
  __shared__ SystemStage::Shared shared;
  const Index i = r.first + thread_index(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  const SystemStage stage(shared, first, min(static_cast<Index>(warpSize), r.end - first));
  Vec3 step_force, end_force, residual;
  Sym3 diagonal, inverse_block;
  StepNorms norms{};
  if (i < r.end) {
    SystemItem<Laws> item{
        {{r.in, laws, {r.of.start.step}}, r.of.gravity, r.of.weights, r.of.forces, r.of.matrix},
        r.residual,
        r.norms};
    item.system.out.step_force = only(step_force, i), item.residual.force = only(step_force, i);
    item.system.out.end_force = only(end_force, i);
    item.system.matrix.diagonal = item.residual.matrix.diagonal = only(diagonal, i);
    item.residual.residual = only(residual, i), item.norms.residual = only(residual, i);
    item.residual.inverse_block = only(inverse_block, i);
    norms = item(i);
  }
  stage.put(step_force, r.of.forces.step_force), stage.put(end_force, r.of.forces.end_force);
  stage.put(diagonal, r.of.matrix.diagonal);
  stage.put(residual, r.residual.residual), stage.put(inverse_block, r.residual.inverse_block);
  block_max(norms.residual, &r.largest->residual);
  block_max(norms.correction_bound, &r.largest->correction_bound);
  block_max(norms.force, &r.largest->force);
  block_max(norms.stiffness_ratio, &r.largest->stiffness_ratio);
}

// Blocks per multiprocessor, which bounds the registers per thread: faster, though a few registers spill.
inline constexpr int kFrictionSystemBlocks = 3;

// Forces, torques and entries of the Newton matrix. Residual, block and norms are computed from these entries
// by items of their own, because the contact loop needs all registers. r.first: a multiple of `kSlice`.
template <class Laws>
__global__ void __launch_bounds__(kSystemThreads, kFrictionSystemBlocks)
    friction_system_kernel(const __grid_constant__ DeviceStepSystem r, const Laws laws) {
  constexpr int kWords = sizeof(FrictionSums) / sizeof(double);
  __shared__ WarpContacts<double, kWords> contacts[kSystemThreads / kSlice];
  const Index i = r.first + thread_index(), first = i - static_cast<Index>(threadIdx.x) % warpSize;
  if (first >= r.end) return;
  const bool idle = i >= r.end;
  const StepSystem& of = r.of;
  const auto views = warp_views(r.in, &contacts[threadIdx.x / kSlice], idle);
  const FrictionSystemItem<Laws, WarpRows<double, kWords>> item{
      {views, laws, {of.start}}, of.gravity,      of.weights, of.forces, of.torques,
      of.friction_matrix,        of.phase_squared};
  auto self = item.walk.self(idle ? r.end - 1 : i);
  auto total = item.weight(self);
  self.i = i;
  item.add_neighbors(self, total);
  if (!idle) item.finish(self, total);
}

// Energy losses of the particles, and the new history of their contacts.
template <class Laws>
__global__ void __launch_bounds__(kSystemThreads)
    friction_losses_kernel(Index n, const __grid_constant__ DeviceViews in,
                           const __grid_constant__ FrictionStart start, const FrictionLossOutputs to,
                           const Laws laws) {
  constexpr int kWords = sizeof(FrictionLossSums<kLossKindsOf<LawOf<Laws>>>) / sizeof(double);
  __shared__ WarpContacts<double, kWords> contacts[kSystemThreads / kSlice];
  const Index i = thread_index();
  if (i - static_cast<Index>(threadIdx.x) % warpSize >= n) return;
  const bool idle = i >= n;
  const auto views = warp_views(in, &contacts[threadIdx.x / kSlice], idle);
  const FrictionLossesItem<Laws, WarpRows<double, kWords>> item{{views, laws, {start}}, to};
  auto self = item.walk.self(idle ? n - 1 : i);
  FrictionLossSums<kLossKindsOf<LawOf<Laws>>> sum;
  self.i = i;
  item.add_neighbors(self, sum);
  if (!idle) item.finish(self, sum);
}

template <class Laws>
class ContactKernelsOf : public DeviceContactKernels {
 public:
  explicit ContactKernelsOf(Laws laws) : laws_(laws) {
    if constexpr (LawOf<Laws>::kNeedsMotion) {
      constexpr std::size_t kShared =
          kFrictionBlocks<Laws> * kStepBlock / kSlice * sizeof(WarpContactsOf<double, Laws>);
      prefer_cache(friction_advance_kernel<Laws>, kShared);
      prefer_cache(friction_finish_kernel<Laws>, kShared);
    } else {
      prefer_cache(verlet_advance_kernel<0, Laws>, verlet_blocks(0) * sizeof(VerletStage::Shared));
    }
  }

  LawTraits traits() const override { return LawTraits::of<LawOf<Laws>>(); }
  void run(Device device, const DeviceViews& in, Index n, const ContactRequest& request) const override {
    with_requested_item(in, laws_, request, [&](const auto& item) { queue(device, n, item); });
  }
  void surface_loads(Device device, Follows follows, const SurfaceViews& in, const LoadChunks& chunks,
                     SurfaceLoad* loads, const LoadSumOutputs& sums) const override {
    if (chunks.count == 0) return;
    launch_dependent(device, follows, load_kernel<Laws>, static_cast<unsigned>(chunks.count), kLoadLanes,
                     chunks.chunks, in, laws_, loads, sums);
  }
  void surface_loads_in_run(Device device, Follows follows, const SurfaceViews& in,
                            const OpenStepQuery& query, Index n, SurfaceLoad* loads) const override {
    if (n == 0) return;
    launch_dependent(device, follows, load_in_run_kernel<Laws>, blocks_for(n, kLoadLanes), kLoadLanes, n, in,
                     query, laws_, loads);
  }
  void surface_steps(Device device, const SurfaceViews& in, const SurfaceChunks& chunks,
                     const SurfaceStart& start, const SurfaceStepsTo& to, StepSums* sums) const override {
    if constexpr (kFreedoms == 6)
      launch_surfaces(device, chunks,
                      SurfaceFrictionItem<Laws>{in, start.particles, start.placed, laws_, to.friction_steps},
                      to.friction_steps, sums);
    else if constexpr (kFreedoms == 3)
      launch_surfaces(device, chunks,
                      SurfaceStepItem<Laws>{in, start.particles.step, start.placed, laws_, to.steps},
                      to.steps, sums);
    else
      refuse_implicit();
  }
  void wall_sums(Device device, const DeviceViews& in, Index n, const WallChoice& choice,
                 ExactSums<kWallTerms>* sums, const std::function<void(Real*)>& share) const override {
    exact_sums(device, n, WallContactItem<Laws, SlicedRows>{{in, laws_}, choice}, sums, share);
  }
  void shown_surfaces(Device device, const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                      ShownContact* shown) const override {
    for_each(device, n, ShownSurfaceItem<Laws>{in, laws_, loads, shown});
  }
  void system(Device device, const DeviceStepSystem& r) const override {
    if (r.end == r.first) return;
    const unsigned blocks = blocks_for(r.end - r.first, kSystemThreads);
    if constexpr (kFreedoms == 6)
      friction_system_kernel<Laws><<<blocks, kSystemThreads, 0, device.stream>>>(r, laws_);
    else if constexpr (kFreedoms == 3)
      system_kernel<Laws><<<blocks, kSystemThreads, 0, device.stream>>>(r, laws_);
    else
      refuse_implicit();
    require_cuda(cudaGetLastError(), "system");
  }
  void verlet_advance(Device device, const VerletRequest& r) const override {
    if constexpr (LawOf<Laws>::kNeedsMotion) {
      launch(device, r, friction_advance_kernel<Laws>);
    } else {
      const bool eagerly = several_at_once(r.rows, verlet_blocks(kFewThreadsAtOnce));
      launch(device, r,
             eagerly ? verlet_advance_kernel<kFewThreadsAtOnce, Laws> : verlet_advance_kernel<0, Laws>);
    }
  }
  void mixed_advance(Device device, const MixedRequest& r) const override {
    if constexpr (!LawOf<Laws>::kNeedsMotion && !kHasRange<LawOf<Laws>>)
      advance_in_mixed(device, r);
    else if constexpr (kHasSingleForm<LawOf<Laws>>)
      launch(device, r, mixed_friction_kernel<Laws>);
    else
      throw std::logic_error("mixed_advance: this law is computed in double precision");
  }
  void verlet_finish(Device device, const VerletRequest& r, Real* largest) const override {
    require_cuda(cudaMemsetAsync(largest, 0, sizeof(Real), device.stream), "explicit step");
    if (r.rows.end == 0) return;
    if constexpr (LawOf<Laws>::kNeedsMotion)
      friction_finish_kernel<Laws>
          <<<blocks_for(r.rows.end, kStepBlock), kStepBlock, 0, device.stream>>>(r, laws_, largest);
    else
      verlet_finish_kernel<Laws>
          <<<blocks_for(r.rows.end), launches().block, 0, device.stream>>>(r, laws_, largest);
    require_cuda(cudaGetLastError(), "explicit step");
  }

 private:
  static constexpr int kFreedoms = kStepFreedoms<LawOf<Laws>>;
  template <class Item>
  static void queue(Device device, Index n, const Item& item) {
    for_each(device, n, item);
  }
  static void queue(Device device, Index n, const FrictionLossesItem<Laws, SlicedRows>& item) {
    if (n == 0) return;
    friction_losses_kernel<Laws><<<blocks_for(n, kSystemThreads), kSystemThreads, 0, device.stream>>>(
        n, item.walk.in, item.walk.kinematics.start, item.to, item.walk.laws);
    require_cuda(cudaGetLastError(), "losses over a step");
  }
  [[noreturn]] static void refuse_implicit() {
    throw std::logic_error("ContactKernelsOf: the law has no such implicit steps");
  }
  // Whether all particles of the step fit on the GPU at once, with this number of blocks per multiprocessor.
  bool several_at_once(const StepRows& rows, int blocks) const {
    const bool fits = rows.launched <= multiprocessors_ * static_cast<unsigned>(blocks);
    return launches().several_at_once.value_or(fits);
  }
  void advance_in_mixed(Device device, const MixedRequest& r) const {
    const bool eagerly = several_at_once(r.rows, mixed_blocks(kFewThreadsAtOnce));
    launch(device, r,
           eagerly ? mixed_advance_kernel<kFewThreadsAtOnce, Laws> : mixed_advance_kernel<0, Laws>);
  }
  template <class Request>
  void launch(Device device, const Request& r, void (*kernel)(Request, Laws)) const {
    // Programmatic dependent launch: blocks of a step start while those of the previous step finish.
    cudaLaunchAttribute overlap{};
    overlap.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    overlap.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t config{};
    config.gridDim = r.rows.launched, config.blockDim = kStepBlock;
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

  // The kernel of an explicit step.
  static auto step_kernel() {
    if constexpr (LawOf<Laws>::kNeedsMotion)
      return friction_advance_kernel<Laws>;
    else
      return verlet_advance_kernel<0, Laws>;
  }

  Laws laws_;
  // Kernels compiled for older generations do not wait for the previous step.
  bool overlaps_ = generation_of(step_kernel()) >= 90;
  unsigned multiprocessors_ = static_cast<unsigned>(multiprocessors());
};

// For several materials, with the table of laws that the kernels read.
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
