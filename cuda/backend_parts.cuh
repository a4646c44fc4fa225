// What the source files of the backend share.
#pragma once

#include "cuda_backend.cuh"
#include "for_each.cuh"

namespace scree {

// What atomicMin starts from: bytes of 0x7f, above every id.
inline constexpr long long kNoId = 0x7f7f7f7f7f7f7f7f;

// Arrays of a snapshot on their way out.
struct CudaBackend::PackArrays {
  DeviceArray<PackedParticle> packed;
  PinnedArray<PackedParticle> h_packed;
  DeviceArray<Real> elastic, pairs;
  DeviceArray<Index> contacts;
  DeviceArray<unsigned long long> ids, sorted_ids;
  DeviceArray<Index> order, sorted_order;
  Event ready;
  std::size_t n = 0;
};

// Both updates of a ghost in one launch.
struct GhostItem {
  HaloPositionItem position;
  HaloItem<Vec4> velocity;
  SCREE_HD void operator()(Index g) const { position(g), velocity(g); }
};

template <class T>
const T& CudaBackend::fetch(T Results::* member) const {
  T& host = h_results_.data()->*member;
  require_cuda(cudaMemcpyAsync(&host, result(member), sizeof(T), cudaMemcpyDeviceToHost, stream_), "cudaMemcpyAsync");
  wait_for(stream_);
  return host;
}

}  // namespace scree
