#include <algorithm>

#include "driven_surfaces.cuh"
#include "for_each.cuh"
#include "step_graph.cuh"

namespace scree {
namespace {

// Groups of threads sum every kGroups-th contact, one thread per term. There are many groups, because each
// waits for the memory at every contact.
constexpr int kSumThreads = 256, kGroup = 8, kGroups = kSumThreads / kGroup;
static_assert(kWrenchTerms <= kGroup);

// What the threads of a block share to add up their sums.
struct SharedSums {
  ExactSum of_thread[kSumThreads];
  Index contacts;
  bool is_last;
};

// The sum of the threads with the same term, for group 0. Every thread calls this; the threads of term 0
// count the contacts of their group.
__device__ void add_up(SharedSums& shared, ExactSum& sum, Index contacts) {
  const int thread = static_cast<int>(threadIdx.x), term = thread % kGroup;
  if (thread == 0) shared.contacts = 0;
  shared.of_thread[thread] = sum;
  __syncthreads();
  if (term == 0) atomicAdd(&shared.contacts, contacts);
  if (thread < kGroup)
    for (int other = 1; other < kGroups; ++other) sum.add(shared.of_thread[other * kGroup + term]);
  __syncthreads();
}

// Writes what group 0 has added up.
__device__ void put(const SharedSums& shared, const ExactSum& sum, Index surface, InstantSums& out) {
  const int thread = static_cast<int>(threadIdx.x);
  if (thread == 0) out.surface = surface, out.contacts = shared.contacts;
  if (thread < kWrenchTerms && shared.contacts > 0) out.sum[thread] = sum;
}

// One block per chunk; the last one of a surface adds up the sums of its chunks.
__global__ void __launch_bounds__(kSumThreads) sum_loads_kernel(const __grid_constant__ LoadSums in) {
  __shared__ SharedSums shared;
  const Index row = *in.opened;
  if (row < 0) return;
  const SurfaceChunk chunk = in.chunks.chunks[blockIdx.x];
  const int thread = static_cast<int>(threadIdx.x), term = thread % kGroup, group = thread / kGroup;
  ExactSum sum;
  Index contacts = 0;
  for (Index k = chunk.first + group; k < chunk.end; k += kGroups) {
    const SurfaceLoad& load = in.loads[in.by_surface[k]];
    if (!load.touches) continue;
    ++contacts;
    if (term < kWrenchTerms) sum.add(sum_term(load, term));
  }
  add_up(shared, sum, contacts);
  const SurfaceParts parts = in.parts[chunk.surface];
  InstantSums& of_surface = in.sums[row * in.surfaces + chunk.surface];
  if (parts.count == 1) return put(shared, sum, chunk.surface, of_surface);
  put(shared, sum, chunk.surface, in.of_chunks[blockIdx.x]);
  __syncthreads();
  if (thread == 0)
    shared.is_last = is_last_block(&in.finished[chunk.surface], static_cast<unsigned>(parts.count));
  __syncthreads();
  if (!shared.is_last) return;
  sum = {}, contacts = 0;
  for (Index part = parts.first + group; part < parts.first + parts.count; part += kGroups) {
    const InstantSums& of_chunk = in.of_chunks[part];
    if (of_chunk.contacts == 0) continue;
    contacts += of_chunk.contacts;
    if (term < kWrenchTerms) sum.add(of_chunk.sum[term]);
  }
  add_up(shared, sum, contacts);
  put(shared, sum, chunk.surface, of_surface);
}

// Calls copy(first row, number of rows) for n consecutive rows of the ring, in one or two parts.
template <class Copy>
void for_rows(Index closed, Index n, const Copy& copy) {
  const Index first = closed % DrivenSurfaces::kRows, at_end = std::min(n, DrivenSurfaces::kRows - first);
  copy(first, at_end);
  if (n > at_end) copy(0, n - at_end);
}

}  // namespace

// Only once: the addresses are part of the key of the steps' graphs.
void DrivenSurfaces::allocate(const HostSurfaces& side, cudaStream_t stream) {
  const std::size_t surfaces = side.placed().size(), frames = side.frames().size();
  h_placed_.resize(kRows * surfaces), placed_.resize(kRows * surfaces);
  h_frames_.resize(kRows * frames), frames_.resize(kRows * frames);
  h_sums_.resize(kRows * surfaces);
  finished_.resize(surfaces), finished_.zero(stream);
  poses_ = {placed_.data(), frames_.data(), static_cast<Index>(surfaces), static_cast<Index>(frames),
            kRows,          opened_.data()};
}

void DrivenSurfaces::prepare(const HostSurfaces& side, const DeviceSurfaces& surfaces, std::int64_t builds,
                             cudaStream_t stream) {
  if (known_list_ == builds) return;
  known_list_ = builds;
  if (h_sums_.size() == 0) allocate(side, stream);
  h_parts_.assign(side.placed().size(), {0, 0});
  const auto& chunks = surfaces.chunks();
  for (std::size_t k = 0; k < chunks.size(); ++k) {
    SurfaceParts& parts = h_parts_[static_cast<std::size_t>(chunks[k].surface)];
    if (parts.count++ == 0) parts.first = static_cast<Index>(k);
  }
  parts_.upload(h_parts_, stream);
  of_chunks_.resize_with_spare(chunks.size());
  sums_ = {surfaces.chunk_list(), parts_.data(),    surfaces.by_surface(), surfaces.loads(), opened_.data(),
           of_chunks_.data(),     finished_.data(), h_sums_.data(),        poses_.surfaces};
}

void DrivenSurfaces::put(Index closed, const HostSurfaces& side) {
  const auto row = static_cast<std::size_t>(closed % kRows);
  std::copy(side.placed().begin(), side.placed().end(), h_placed_.data() + row * side.placed().size());
  std::copy(side.frames().begin(), side.frames().end(), h_frames_.data() + row * side.frames().size());
}

void DrivenSurfaces::upload(Index closed, Index n, cudaStream_t stream) {
  const auto copy_rows = [&](auto& to, const auto& from, Index width, Index first, Index rows) {
    const auto at = static_cast<std::size_t>(first) * static_cast<std::size_t>(width);
    copy_async(to.data() + at, from.data() + at,
               static_cast<std::size_t>(rows) * static_cast<std::size_t>(width), stream);
  };
  for_rows(closed, n, [&](Index first, Index rows) {
    copy_rows(placed_, h_placed_, poses_.surfaces, first, rows);
    copy_rows(frames_, h_frames_, poses_.frame_count, first, rows);
  });
}

void DrivenSurfaces::queue_sums(Device on) {
  if (sums_.chunks.count == 0) return;
  loads_found_.record(on.stream), loads_found_.hold(stream_);
  sum_loads_kernel<<<static_cast<unsigned>(sums_.chunks.count), kSumThreads, 0, stream_>>>(sums_);
  require_cuda(cudaGetLastError(), "sums of contacts with walls");
  summed_.record(stream_);
}

void DrivenSurfaces::join(Device on) const {
  if (sums_.chunks.count > 0) summed_.hold(on.stream);
}

std::string DrivenSurfaces::key() const { return key_of(sums_); }

void DrivenSurfaces::take(Index closed, std::int64_t step, std::vector<StepLoads>& loads) const {
  const auto row = static_cast<std::size_t>(closed % kRows);
  for (std::size_t s = 0; s < h_parts_.size(); ++s) {
    if (h_parts_[s].count == 0) continue;
    const InstantSums& sums = h_sums_[row * h_parts_.size() + s];
    if (sums.contacts > 0) loads.push_back({step, sums});
  }
}

}  // namespace scree
