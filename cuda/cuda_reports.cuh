// Reports of the GPU backend on its particles: sums, and values for output.
#pragma once

#include <cstddef>
#include <vector>

#include "cuda_bodies.cuh"
#include "dem/backend/reports.hpp"
#include "trace_item.cuh"

namespace scree {

class CudaReports : public Reports {
 public:
  CudaReports(CudaItems& items, CudaBodies& bodies);

  ParticleLedger ledger(Real verlet_step) override;
  Real inside_kinetic() override;
  void start_output() override;
  ParticleOutput output() override;
  ShapePack pack_shapes() override;
  ContactLines contact_lines() override;
  RegionSums in_region(const RegionBounds& region) override;
  std::vector<TracedParticle> traced(std::span<const GlobalId> requested) override;
  std::vector<ContactSum> parent_contacts() override;
  std::vector<ContactSum> surface_contacts() override;
  std::vector<ContactSum> wall_contacts(std::span<const int> walls) override;
  std::vector<TriangleLoad> triangle_loads() override;

 private:
  // Values of a snapshot on their way to the host: those of one field, and of all.
  struct FieldColumn {
    OutputField field;
    DeviceArray<std::byte> values;
    PinnedArray<std::byte> h_values;
  };
  struct OutputArrays {
    std::vector<FieldColumn> columns;
    DeviceArray<Vec3> position;
    PinnedArray<Vec3> h_position;
    PinnedArray<unsigned long long> h_ids;
    DeviceArray<unsigned long long> ids, sorted_ids;
    DeviceArray<Index> order, sorted_order;
    Event filled, ready;
    std::size_t n = 0;
  };
  void find_loads() override { bodies_.find_loads(); }
  void queue_energies();
  void queue_order();
  void queue_values();
  LineRequest count_lines();

  CudaItems& items_;
  CudaBodies& bodies_;
  Stream copy_stream_;  // stream for copies concurrent with the steps
  OutputArrays output_;
  // Per particle, over its contacts.
  DeviceArray<Real> elastic_, pairs_, cohesion_;
  DeviceArray<Index> contacts_;
  DeviceArray<SpringEnergies> springs_;
  // Empty unless contacts are written: the offsets of each particle's lines, and a batch of lines.
  DeviceArray<Index> line_offsets_;
  DeviceArray<ContactLine> lines_;
  DeviceArray<GlobalId> traced_ids_;
  DeviceArray<TracedParticle> traced_;
};

}  // namespace scree
