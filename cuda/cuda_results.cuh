// Small results that the device writes and the host reads.
#pragma once

#include <array>
#include <span>

#include "contact_kernels.cuh"
#include "dem/implicit/rotation_items.hpp"
#include "dem/reports/ledger_items.hpp"
#include "dem/reports/region_items.hpp"
#include "dem/surface_contact/wall_items.hpp"
#include "device.cuh"
#include "partition/ranks.hpp"
#include "sums.cuh"

namespace scree {

// Initial value of minima of ids: bytes of 0x7f, above every id.
inline constexpr long long kNoId = 0x7f7f7f7f7f7f7f7f;

struct Results {
  Real largest;
  Index index, escaped_particles;
  ExactSums<1> slope, cohesion;
  long long worst_id;
  ExactSums<kLedgerTerms> ledger;
  // All blocks of a step add to its first members and read the others. As placed here, a cache line ends
  // between the two; with both in one line, an explicit step of 1e6 particles took 4 % (double) and 10 %
  // (mixed) longer on an H200.
  VerletControl control;
  // Numbers of particles: in the interior, in the search, and on this rank after migration.
  Index interior, active, staying;
  ExactSums<kWallTerms> wall;
  ExactSums<kRotationTerms> rotation;
  ExactSums<kInsideTerms> inside;
  ExactSums<1> inside_kinetic;
  FrictionNorms norms;
  ExactSums<kRegionTerms> region;
};

class DeviceResults {
 public:
  DeviceResults(const Ranks& ranks, cudaStream_t stream) : ranks_(ranks), stream_(stream) {
    on_device_.zero(stream);
  }

  template <class T>
  T* at(T Results::*member) {
    return &(on_device_.data()->*member);
  }
  Results& host() { return on_host_[0]; }  // the last copy
  // Queues the copy of one member to the host.
  template <class T>
  void copy(T Results::*member, cudaStream_t stream) {
    copy_async(&(on_host_.data()->*member), at(member), 1, stream);
  }
  template <class T>
  void copy(T Results::*member) {
    copy(member, stream_);
  }
  // The same, and waits for the stream.
  template <class T>
  const T& fetch(T Results::*member) {
    copy(member);
    wait_for(stream_);
    return on_host_.data()->*member;
  }

  // Where kernels write the smallest of some ids, initially `kNoId`; then its value on the host, over all
  // ranks.
  long long* clear_id() {
    require_cuda(cudaMemsetAsync(at(&Results::worst_id), 0x7f, sizeof(long long), stream_),
                 "cudaMemsetAsync");
    return at(&Results::worst_id);
  }
  long long smallest_id() { return ranks_.min(fetch(&Results::worst_id)); }

  // Totals over all ranks, of sums that have been copied to the host.
  template <int N>
  std::array<Real, N> totals(const ExactSums<N>& sums) const {
    std::array<__int128, N> quanta;
    for (int k = 0; k < N; ++k) quanta[k] = sums.quanta(k);
    ranks_.sum(std::span<__int128>(quanta));
    std::array<Real, N> totals;
    for (int k = 0; k < N; ++k) totals[k] = ReproducibleScale(sums.largest[k]).value(quanta[k]);
    return totals;
  }

 private:
  Ranks ranks_;
  cudaStream_t stream_;
  DeviceArray<Results> on_device_{1};
  PinnedArray<Results> on_host_{1};
};

}  // namespace scree
