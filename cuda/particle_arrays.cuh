// Particles on the device: the arrays of ParticleStore, twice, so that sorting, explicit and implicit steps
// can read one and write the other.
#pragma once

#include "dem/particle_fields.hpp"
#include "device.cuh"

namespace scree {

struct ParticleArrays : FieldArrays<DeviceArray>, FieldsThere {
  // Room for so many items and particles; the first `keep` items stay.
  void grow(std::size_t items, std::size_t owned, std::size_t keep, cudaStream_t stream) {
    for_each_array<kItemArrays>(
        FieldsThere(*this), [&](auto& array) { array.grow(items, keep, stream); }, *this);
    keep = std::min(keep, owned);
    for_each_array<kOwnedArrays>(
        FieldsThere(*this), [&](auto& array) { array.grow(owned, keep, stream); }, *this);
  }
};

// to[i] = from[order[i]].
struct ReorderItem {
  ParticleViews from, to;
  const Index* order;

  SCREE_HD void operator()(Index i) const {
    const Index k = order[i];
    const auto copy = [&](auto* new_values, const auto* values) { new_values[i] = values[k]; };
    for_each_array<kAllArrays>(copy, to, from);
    if (from.angular_velocity != nullptr) for_each_array<kRotationArrays>(copy, to, from);
    if (from.rolling_loss != nullptr) for_each_array<kOwnedRolling>(copy, to, from);
  }
};

// Records of the particles from `first` on: position inside the periodic box, but for those that drift.
struct RecordItem {
  ParticleViews in;
  Index first;
  Vec3 box_min, period;
  Particle* out;

  SCREE_HD void operator()(Index k) const {
    Particle p = particle_at(in, first + k);
    if (!p.drifting) p.position = wrap(box_min, period, p.position, p.image);
    out[k] = p;
  }
};

// Records become the particles from `first` on.
struct ArrivalItem {
  const Particle* arriving;
  ParticleViews out;
  Index first;

  SCREE_HD void operator()(Index k) const { put_particle(out, first + k, arriving[k]); }
};

}  // namespace scree
