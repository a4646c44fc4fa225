// The particles of one rank on its GPU.
#pragma once

#include <vector>

#include "cuda_list.cuh"
#include "dem/backend/rank_particles.hpp"

namespace scree {

class CudaParticles : public RankParticles {
 public:
  CudaParticles(CudaItems& items, CudaBodies& bodies, CudaList& list);

  void load(const std::vector<Particle>& records, const ShapeLosses& shapes) override;
  std::vector<Particle> records() override;
  void load_contacts(const PackedHistory& contacts) override { items_.history.load(contacts, items_.owned); }
  PackedHistory contacts() override;
  ShapeLosses shape_losses() const override { return bodies_.side().losses(); }
  void load_shape_contacts(const ShapeContacts& contacts) override { bodies_.side().load_contacts(contacts); }
  ShapeContacts shape_contacts() override { return bodies_.side().shape_contacts(); }
  void load_works(const std::vector<std::int64_t>& words) override {
    items_.surfaces.works().load(words, items_.stream);
  }
  std::vector<std::int64_t> works() override {
    std::vector<std::int64_t> words = items_.surfaces.works().limbs(items_.stream);
    bodies_.side().add_works(words);
    return words;
  }
  void initial_forces() override;
  void reduce_wrench(std::vector<BodyWrench>& wrench) override { bodies_.reduce_wrench(wrench); }
  std::vector<std::uint8_t> overlapped(const CandidateGrid& candidates) override;
  void insert(const std::vector<Particle>& born) override;
  void remove_escaped(const std::vector<EscapedParticle>& escaped) override;

 private:
  std::vector<EscapedParticle> find_leaving(std::span<const OutletRegion> outlets) override;
  RecordItem record_item(Index first);
  std::size_t find_escaped_particles();
  void remove_escaped_contacts();

  CudaItems& items_;
  CudaBodies& bodies_;
  CudaList& list_;
  DeviceArray<Particle> records_;  // records in transit between host and device
  DeviceArray<EscapedParticle> escaped_particles_;
  RemainingSpace space_;  // of the last outside()
};

}  // namespace scree
