// Assignment of the particles to the ranks, if there are several: src/dem/cpu/cpu_list.cpp for the GPU
// backend. Particles that migrate to another rank, few after the first list, go through the host.
#pragma once

#include <vector>

#include "cuda_items.cuh"
#include "dem/particles/particle_fields.hpp"

namespace scree {

// Mark in `ParticleArrays::drifting`: another rank owns the particle from now on.
inline constexpr std::uint8_t kMigrated = 2;

class CudaOwners {
 public:
  CudaOwners(CudaItems& items, const NeighborBuilder& builder) : items_(items), builder_(builder) {}

  const Decomposition& decomposition() const { return decomposition_; }
  // Sends every particle to the rank whose box it is in. Those that departed stay in the arrays, marked,
  // until the sort by cell drops them, which arrived() acknowledges.
  void migrate();
  void arrived() { migrating_ = false; }
  bool migrating() const { return migrating_; }
  // Appends those of these particles that this rank owns. The contact history must be packed.
  void insert(const std::vector<Particle>& born);

  // After a list was built: stores the lengths of its rows as costs; the second one measures the load balance
  // from them.
  void note_rows();
  void measure_balance();
  DeviceArray<Index>& row_length() { return row_length_; }

 private:
  void decompose();
  std::vector<Particle> pack_migrants(Index* departing, Index count);
  void add_migrants(const std::vector<Particle>& arriving);

  CudaItems& items_;
  const NeighborBuilder& builder_;
  Decomposition decomposition_;
  DeviceArray<DomainCut> cuts_;
  DeviceArray<Index> row_length_;  // row lengths in the last list, with several ranks
  bool migrating_ = false;         // marked particles have not been dropped yet
};

}  // namespace scree
