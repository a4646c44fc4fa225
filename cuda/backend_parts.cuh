// What the source files of the backend share.
#pragma once

#include "cuda_backend.cuh"
#include "for_each.cuh"

namespace scree {

// What atomicMin starts from: bytes of 0x7f, above every id.
inline constexpr long long kNoId = 0x7f7f7f7f7f7f7f7f;

// In ParticleArrays::drifting: a particle that another rank owns from now on.
inline constexpr std::uint8_t kGone = 2;

// Arrays of a snapshot on their way out.
struct CudaBackend::PackArrays {
  SnapshotArrays<DeviceArray> packed;
  SnapshotArrays<PinnedArray> h_packed;
  PinnedArray<unsigned long long> h_ids;
  DeviceArray<Real> elastic, pairs;
  DeviceArray<Index> contacts;
  DeviceArray<unsigned long long> ids, sorted_ids;
  DeviceArray<Index> order, sorted_order;
  Event ready;
  std::size_t n = 0;
};

template <class T>
const T& CudaBackend::fetch(T Results::*member) const {
  T& host = h_results_.data()->*member;
  require_cuda(cudaMemcpyAsync(&host, result(member), sizeof(T), cudaMemcpyDeviceToHost, stream_),
               "cudaMemcpyAsync");
  wait_for(stream_);
  return host;
}

// Queues a pass over the particles that needs their ghosts: queue_ghosts(device), queue_rows(device, first,
// end). With several ranks the interior, which meets no ghosts, is computed while the halo is under way, and
// the rest beside it as soon as that is there. Both streams stand where the pass may begin; afterwards the
// halo's stands behind it, so that the next halo begins before the next rows fill the GPU. clock: if given,
// it looks.
template <class QueueGhosts, class QueueRows>
void CudaBackend::queue_beside_halo(const QueueGhosts& queue_ghosts, const QueueRows& queue_rows,
                                    HaloClock* clock) {
  if (ranks_.alone()) {
    queue_ghosts(device());
    queue_rows(device(), 0, owned_);
    return;
  }
  if (clock != nullptr) clock->begin(halo_stream_);
  if (interior_ > 0) queue_rows(device(), 0, interior_);
  if (clock != nullptr) clock->interior_done(stream_);
  queue_ghosts({halo_stream_});
  if (clock != nullptr) clock->end(halo_stream_);
  queue_rows({halo_stream_}, interior_, owned_);
  halo_after_rows();
}

template <int N, class Item>
void CudaBackend::queue_sums(const Item& item, ExactSums<N> Results::*sums) const {
  exact_sums(device(), owned_, item, result(sums), [&](Real* largest) { halo_.max(device(), largest, N); });
}

template <int N>
std::array<Real, N> CudaBackend::totals(const ExactSums<N>& sums) const {
  std::array<__int128, N> quanta;
  for (int k = 0; k < N; ++k) quanta[k] = sums.quanta(k);
  ranks_.sum(std::span<__int128>(quanta));
  std::array<Real, N> totals;
  for (int k = 0; k < N; ++k) totals[k] = ReproducibleScale(sums.largest[k]).value(quanta[k]);
  return totals;
}

}  // namespace scree
