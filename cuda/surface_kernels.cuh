// Contacts of particles with surfaces of one law as kernels, and their sums.
#pragma once

#include "contact_kernels.cuh"
#include "dependent_launch.cuh"
#include "for_each.cuh"
#include "lane_team.cuh"
#include "staging.cuh"

namespace scree {

inline constexpr int kSurfaceThreads = 64;

// Evaluates the contacts of a chunk over an implicit step, one per thread at a time, and then sums them: each
// thread adds one term of the contacts. The sums are exact, so the order has no influence.
template <class Item, class Contact, int kTerms>
__global__ void __launch_bounds__(kSurfaceThreads)
    surface_kernel(const SurfaceChunk* chunks, const __grid_constant__ Item item, const Contact* contacts,
                   SurfaceSums<kTerms>* sums) {
  static_assert(kTerms <= kSurfaceThreads);
  const SurfaceChunk chunk = chunks[blockIdx.x];
  const int thread = static_cast<int>(threadIdx.x);
  for (Index k = chunk.first + thread; k < chunk.end; k += kSurfaceThreads) item(k);
  __syncthreads();
  ExactSum sum;
  Index touching = 0;
  for (Index k = chunk.first; k < chunk.end; ++k) {
    const Contact& contact = contacts[item.in.entries.by_surface[k]];
    if (!contact.touches) continue;
    ++touching;
    if (thread < kTerms) sum.add(sum_term(contact, thread));
  }
  SurfaceSums<kTerms>& out = sums[blockIdx.x];
  if (thread == 0) out.surface = chunk.surface, out.contacts = touching;
  if (touching > 0 && thread < kTerms) out.sum[thread] = sum;
}

inline constexpr int kLoadBlocks = 12;  // blocks per multiprocessor: with more, registers spill
using LoadRecords = WarpRecords<SurfaceLoad, kLoadLanes>;

// Evaluates the load of the k-th entry by_surface into the lane's record. Returns the entry, -1 if it does
// not touch.
template <class Laws>
__device__ Index find_load(const SurfaceViews& in, const Laws& laws, Index k, SurfaceLoad& record,
                           SurfaceLoad* loads) {
  const Index entry = in.entries.by_surface[k];
  SurfaceLoadItem<Laws>{in, laws, only(record, entry)}(k);
  if (record.touches) return entry;
  loads[entry].touches = false;
  return -1;
}

// Sums of loads formed by a warp: groups of eight lanes, one per term. All lanes call its functions.
class WarpLoadSums {
 public:
  static constexpr int kGroup = 8, kGroups = kLoadLanes / kGroup;
  static_assert(kWrenchTerms <= kGroup);

  // The contacts of the warp that touch, few in general; each group takes every kGroups-th of them.
  __device__ void add_contacts(const LoadRecords& records, bool touches) {
    unsigned left = __ballot_sync(~0u, touches);
    contacts_ = __popc(left);
    const auto leave_out = [&](int lanes) {
      for (; lanes > 0; --lanes) left &= left - 1;
    };
    for (leave_out(group()); left != 0; leave_out(kGroups))
      if (has_term()) sum_.add(sum_term(records.of(__ffs(static_cast<int>(left)) - 1), term()));
    add_up();
  }
  // Sums of chunks, of which each group takes every kGroups-th.
  __device__ void add_chunks(const InstantSums* chunks, Index count) {
    constexpr int kAtOnce = 4;  // loads that do not wait for each other
    for (Index first = group(); first < count; first += kAtOnce * kGroups) {
      ExactSum sums[kAtOnce];
#pragma unroll
      for (int k = 0; k < kAtOnce; ++k)
        if (const Index chunk = first + k * kGroups; chunk < count) {
          contacts_ += chunks[chunk].contacts;
          if (has_term()) sums[k] = chunks[chunk].sum[term()];
        }
      for (const ExactSum& sum : sums) sum_.add(sum);
    }
    contacts_ = LaneTeam<kLoadLanes>::reduce<kGroup>(contacts_, [](Index a, Index b) { return a + b; });
    add_up();
  }
  __device__ void write(Index surface, InstantSums& to) const {
    if (threadIdx.x == 0) to.surface = surface, to.contacts = contacts_;
    if (group() == 0 && has_term()) to.sum[term()] = sum_;
    __syncwarp();
  }
  // To the memory of the host, which waits for the number of the evaluation.
  __device__ void write_to_host(Index surface, const LoadSumOutputs& out) const {
    write(surface, out.of_surfaces[surface]);
    if (threadIdx.x > 0) return;
    const cuda::atomic_ref<unsigned, cuda::thread_scope_system> written_by(out.written_by[surface]);
    cuda::atomic_thread_fence(cuda::memory_order_release, cuda::thread_scope_system);
    written_by.store(out.evaluation, cuda::memory_order_relaxed);
  }

 private:
  __device__ static Index group() { return static_cast<Index>(threadIdx.x / kGroup); }
  __device__ static int term() { return static_cast<int>(threadIdx.x % kGroup); }
  __device__ static bool has_term() { return term() < kWrenchTerms; }
  // Adds the sums of the groups.
  __device__ void add_up() {
    sum_ = LaneTeam<kLoadLanes>::reduce<kGroup>(sum_, [](ExactSum a, const ExactSum& b) {
      a.add(b);
      return a;
    });
  }

  ExactSum sum_;
  Index contacts_ = 0;
};

__device__ inline void copy_by_warp(const ControlReport& report) {
  using Word = unsigned long long;
  static_assert(sizeof(VerletControl) % sizeof(Word) == 0);
  if (report.from == nullptr) return;
  const auto* from = reinterpret_cast<const Word*>(report.from);
  auto* to = reinterpret_cast<Word*>(report.to);
  for (unsigned k = threadIdx.x; k < sizeof(VerletControl) / sizeof(Word); k += kLoadLanes) to[k] = from[k];
}

// Begins to load what the contact of an entry reads of its particle.
__device__ inline void prefetch_entry(const SurfaceViews& in, Index entry) {
  const Index i = in.entries.particles[entry];
  prefetch_record(in.position + i), prefetch_record(in.velocity + i);
  if (in.spin != nullptr) prefetch_record(in.spin + i);
  if (in.history.bodies != nullptr) prefetch_record(in.history.bodies + std::int64_t{entry} * in.records);
}

// Contacts of a chunk at an instant or over an explicit step, one per lane of a warp: few of them touch. The
// warp that ends last of those of a surface adds up the sums of their chunks, so that the host reads one
// record per surface. The sums are exact, so the order has no influence.
template <class Laws>
__global__ void __launch_bounds__(kLoadLanes)
    load_kernel(const LoadChunk* chunks, const __grid_constant__ SurfaceViews in, const Laws laws,
                SurfaceLoad* loads, const LoadSumOutputs out) {
  __shared__ LoadRecords::Shared shared;
  admit_next_kernel();
  const LoadRecords records(shared);
  const LoadChunk chunk = chunks[blockIdx.x];
  const Index surface = chunk.of.surface, k = chunk.of.first + static_cast<Index>(threadIdx.x);
  if (k < chunk.of.end) prefetch_entry(in, in.entries.by_surface[k]);
  await_kernel_before();  // for the contacts with meshes
  const Index touching = k < chunk.of.end ? find_load(in, laws, k, records.own(), loads) : -1;
  records.store(loads, touching);
  if (blockIdx.x == 0) copy_by_warp(out.report);
  WarpLoadSums sums;
  sums.add_contacts(records, touching >= 0);
  if (chunk.parts == 1) return sums.write_to_host(surface, out);
  sums.write(surface, out.of_chunks[blockIdx.x]);
  bool is_last = false;
  if (threadIdx.x == 0) is_last = is_last_block(&out.finished[surface], static_cast<unsigned>(chunk.parts));
  __syncwarp();
  if (!__any_sync(~0u, is_last)) return;
  WarpLoadSums of_surface;
  of_surface.add_chunks(out.of_chunks + chunk.first_part, chunk.parts);
  of_surface.write_to_host(surface, out);
}

// Contacts with surfaces of the explicit step that is open when the kernel runs, in the order by_surface.
template <class Laws>
__global__ void __launch_bounds__(kLoadLanes, kLoadBlocks)
    load_in_run_kernel(Index n, const __grid_constant__ SurfaceViews in, const OpenStepQuery query,
                       const Laws laws, SurfaceLoad* loads) {
  __shared__ LoadRecords::Shared shared;
  admit_next_kernel();
  await_kernel_before();
  SurfaceViews now = in;
  now.free_bodies = nullptr;  // surfaces at rest or driven: the compiler leaves out what moves bodies
  if (!query.open(now)) return;
  const LoadRecords records(shared);
  const Index k = thread_index();
  Index touching = -1;
  if (k < n) touching = find_load(now, laws, k, records.own(), loads);
  records.store(loads, touching);
}

}  // namespace scree
