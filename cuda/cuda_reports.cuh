// What the GPU's backend tells about its particles: sums, packs for output.
#pragma once

#include <vector>

#include "cuda_bodies.cuh"
#include "dem/reports.hpp"
#include "pack_items.cuh"

namespace scree {

class CudaReports : public Reports {
 public:
  CudaReports(CudaItems& items, CudaBodies& bodies) : items_(items), bodies_(bodies) {}

  ParticleLedger ledger(Real verlet_step) override;
  void start_pack() override;
  ParticlePack pack_particles() override;
  ShapePack pack_shapes() override;
  std::vector<TracedParticle> traced(std::span<const GlobalId> wanted) override;
  std::vector<ContactSum> body_contacts() override;
  std::vector<ContactSum> wall_contacts(std::span<const int> walls) override;

 private:
  // Arrays of a snapshot on their way out.
  struct PackArrays {
    SnapshotArrays<DeviceArray> packed;
    SnapshotArrays<PinnedArray> h_packed;
    PinnedArray<unsigned long long> h_ids;
    DeviceArray<unsigned long long> ids, sorted_ids;
    DeviceArray<Index> order, sorted_order;
    Event packed_now, ready;
    std::size_t n = 0;
  };
  void queue_energies();
  void queue_pack();

  CudaItems& items_;
  CudaBodies& bodies_;
  Stream copy_stream_;  // for what goes out beside the steps
  PackArrays pack_;
  // Of each particle's contacts.
  DeviceArray<Real> elastic_, pairs_;
  DeviceArray<Index> contacts_;
  DeviceArray<GlobalId> traced_ids_;
  DeviceArray<TracedParticle> traced_;
};

}  // namespace scree
