// What the serial backend tells about its particles: sums, packs for output.
#pragma once

#include <utility>

#include "dem/cpu_items.hpp"
#include "dem/reports.hpp"

namespace scree {

class CpuReports : public Reports {
 public:
  explicit CpuReports(CpuItems& items) : items_(items) {}

  ParticleLedger ledger(Real verlet_step) override;
  void start_pack() override;
  ParticlePack pack_particles() override { return std::move(pack_); }
  ShapePack pack_shapes() override;
  std::vector<TracedParticle> traced(std::span<const GlobalId> wanted) override;
  std::vector<ContactSum> body_contacts() override;
  std::vector<ContactSum> wall_contacts(std::span<const int> walls) override;

 private:
  CpuItems& items_;
  ParticlePack pack_;  // of start_pack
};

}  // namespace scree
