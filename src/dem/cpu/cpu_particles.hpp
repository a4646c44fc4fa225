// The particles of one rank on the serial backend.
#pragma once

#include <vector>

#include "dem/backend/rank_particles.hpp"
#include "dem/cpu/cpu_list.hpp"

namespace scree {

class CpuParticles : public RankParticles {
 public:
  CpuParticles(CpuItems& items, CpuList& list) : items_(items), list_(list) {}

  void load(const std::vector<Particle>& records, const ShapeLosses& shapes) override;
  std::vector<Particle> records() override;
  void load_contacts(const PackedHistory& contacts) override {
    items_.history.load(contacts, items_.store.owned);
  }
  PackedHistory contacts() override;
  ShapeLosses shape_losses() const override { return items_.side.losses(); }
  void load_shape_contacts(const ShapeContacts& contacts) override { items_.side.load_contacts(contacts); }
  ShapeContacts shape_contacts() override { return items_.side.shape_contacts(); }
  void load_works(const std::vector<std::int64_t>& words) override { items_.surfaces.load_works(words); }
  std::vector<std::int64_t> works() override;
  void initial_forces() override;
  void reduce_wrench(std::vector<BodyWrench>& wrench) override { items_.reduce_wrench(wrench); }
  std::vector<std::uint8_t> overlapped(const CandidateGrid& candidates) override;
  void insert(const std::vector<Particle>& born) override;
  void remove_escaped(const std::vector<EscapedParticle>& escaped_particles) override;

 private:
  std::vector<EscapedParticle> find_leaving(std::span<const OutletRegion> outlets) override;
  void remove_escaped_contacts();

  CpuItems& items_;
  CpuList& list_;
  RemainingSpace space_;  // of the last outside()
};

}  // namespace scree
