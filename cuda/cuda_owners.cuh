// Which rank owns which particles where there are several: src/dem/cpu/cpu_list.cpp for the GPU's backend.
// Particles that change their rank, few after the first list, go through the host.
#pragma once

#include <vector>

#include "cuda_items.cuh"
#include "dem/particles/particle_fields.hpp"

namespace scree {

// In ParticleArrays::drifting: a particle that another rank owns from now on.
inline constexpr std::uint8_t kGone = 2;

class CudaOwners {
 public:
  CudaOwners(CudaItems& items, const NeighborBuilder& builder) : items_(items), builder_(builder) {}

  const Decomposition& decomposition() const { return decomposition_; }
  // Every particle to the rank whose box it is in. Those that go stay in the arrays, marked, until the sort
  // leaves them behind; arrived() says that it has.
  void migrate();
  void arrived() { migrating_ = false; }
  bool migrating() const { return migrating_; }

  // When a list was built: keeps the lengths of its rows, and what it says about the balance.
  void note_rows();
  void measure_balance();
  DeviceArray<Index>& row_length() { return row_length_; }

 private:
  void decompose();
  std::vector<Particle> pack_migrants(Index* leaving, Index count);
  void add_migrants(const std::vector<Particle>& arriving);

  CudaItems& items_;
  const NeighborBuilder& builder_;
  Decomposition decomposition_;
  DeviceArray<DomainCut> cuts_;
  DeviceArray<Index> row_length_;  // of the particles in the last list, with several ranks
  bool migrating_ = false;         // some are on their way between ranks
};

}  // namespace scree
