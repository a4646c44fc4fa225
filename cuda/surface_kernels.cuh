// Contacts of particles with surfaces of one law as kernels, and their sums per chunk of entries.
#pragma once

#include "contact_kernels.cuh"
#include "for_each.cuh"
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

inline constexpr int kLoadThreads = kChunkEntries;
inline constexpr int kLoadBlocks = 4;  // blocks per multiprocessor: with more, registers spill
using LoadRecords = WarpRecords<SurfaceLoad, kLoadThreads>;

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

// Contacts of a chunk at an instant or over an explicit step, one per thread, and their sums: few of them
// touch. Groups of eight lanes, one per term, take the touching contacts of their warp in turn; the sums of
// the groups are then added pairwise. The sums are exact, so the order has no influence.
template <class Laws>
__global__ void __launch_bounds__(kLoadThreads)
    load_kernel(const SurfaceChunk* chunks, const __grid_constant__ SurfaceViews in, const Laws laws,
                SurfaceLoad* loads, InstantSums* sums) {
  constexpr int kGroup = 8, kGroups = 32 / kGroup;  // of a warp
  static_assert(kWrenchTerms <= kGroup);
  __shared__ LoadRecords::Shared shared;
  __shared__ ExactSum part[kLoadThreads];
  const LoadRecords records(shared);
  const SurfaceChunk chunk = chunks[blockIdx.x];
  const auto thread = static_cast<Index>(threadIdx.x), k = chunk.first + thread;
  const Index touching = k < chunk.end ? find_load(in, laws, k, records.own(), loads) : -1;
  records.store(loads, touching);
  const int contacts = __syncthreads_count(touching >= 0);
  InstantSums& out = sums[blockIdx.x];
  if (thread == 0) out.surface = chunk.surface, out.contacts = contacts;
  if (contacts == 0) return;
  ExactSum sum;
  const int term = thread % kGroup;
  unsigned left = __ballot_sync(~0u, touching >= 0);
  const auto leave_out = [&](int lanes) {
    for (; lanes > 0; --lanes) left &= left - 1;
  };
  for (leave_out(thread % warpSize / kGroup); left != 0; leave_out(kGroups))
    if (term < kWrenchTerms) sum.add(sum_term(records.of(__ffs(static_cast<int>(left)) - 1), term));
  part[thread] = sum;
  for (int half = kLoadThreads / 2; half >= kGroup; half /= 2) {
    __syncthreads();
    if (thread >= half) continue;
    sum.add(part[thread + half]);
    part[thread] = sum;
  }
  if (thread < kWrenchTerms) out.sum[thread] = sum;
}

// Contacts with static surfaces of the explicit step that is open when the kernel runs, in the order
// by_surface.
template <class Laws>
__global__ void __launch_bounds__(kLoadThreads, kLoadBlocks)
    load_in_run_kernel(Index n, const __grid_constant__ SurfaceViews in, const OpenStepQuery query,
                       const Laws laws, SurfaceLoad* loads) {
  __shared__ LoadRecords::Shared shared;
  SurfaceViews now = in;
  if (!query.open(now)) return;
  const LoadRecords records(shared);
  const Index k = thread_index();
  Index touching = -1;
  if (k < n) touching = find_load(now, laws, k, records.own(), loads);
  records.store(loads, touching);
}

}  // namespace scree
