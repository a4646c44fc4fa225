// Reports of the serial backend: sums and output values.
#pragma once

#include <utility>
#include <vector>

#include "dem/backend/reports.hpp"
#include "dem/cpu/cpu_items.hpp"

namespace scree {

class CpuReports : public Reports {
 public:
  explicit CpuReports(CpuItems& items) : items_(items), fields_(computed_fields(items.model.output)) {}

  ParticleLedger ledger(Real verlet_step) override;
  Real inside_kinetic() override;
  void start_output() override;
  ParticleOutput output() override { return std::move(output_); }
  ShapePack pack_shapes() override;
  ContactLines contact_lines() override;
  RegionSums in_region(const RegionBounds& region) override;
  std::vector<TracedParticle> traced(std::span<const GlobalId> requested) override;
  std::vector<ContactSum> parent_contacts() override;
  std::vector<ContactSum> surface_contacts() override;
  std::vector<ContactSum> wall_contacts(std::span<const int> walls) override;
  std::vector<TriangleLoad> triangle_loads() override;

 private:
  void find_loads() override { items_.find_loads(); }

  CpuItems& items_;
  std::vector<OutputField> fields_;
  ParticleOutput output_;  // filled by start_output
};

}  // namespace scree
