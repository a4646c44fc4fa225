// Particles on the device: the arrays of `ParticleStore`, and second arrays of what steps read and write.
#pragma once

#include <array>

#include "dem/explicit/mixed_items.hpp"
#include "dem/particles/particle_fields.hpp"
#include "device_arena.cuh"

namespace scree {

struct ParticleArrays : FieldArrays<DeviceArray>, FieldsThere {
  // Sizes the arrays for that many items and particles; keeps the first `keep` items.
  void grow(std::size_t items, std::size_t owned, std::size_t keep, cudaStream_t stream) {
    for_each_array<kItemArrays>(
        FieldsThere(*this), [&](auto& array) { array.grow(items, keep, stream); }, *this);
    keep = std::min(keep, owned);
    for_each_array<kOwnedArrays>(
        FieldsThere(*this), [&](auto& array) { array.grow(owned, keep, stream); }, *this);
  }
  // Shrinks arrays that are much too large for both numbers; keeps the first `keep` items.
  void trim(std::size_t keep, cudaStream_t stream) {
    for_each_array<kAllArrays | kOptionalArrays>(
        [&](auto& array) { array.trim(std::min(keep, array.size()), stream); }, *this);
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for_each_array<kAllArrays | kOptionalArrays>([&](const auto& array) { sum += array.bytes(); }, *this);
    return sum;
  }
};

// An explicit step reads one array and writes the other; an implicit one keeps its start in these. While a
// list is built they serve as scratch memory: for the sort, and before and after it for the packed contact
// history.
struct SecondArrays {
  bool rotates = false, implicit = false;
  DeviceArray<Vec4> position, velocity, angular_velocity;  // all items
  DeviceArray<Vec3> acceleration, angular_acceleration;    // of particles, for implicit steps

  std::array<DeviceArray<Vec4>*, 3> motion() { return {&position, &velocity, &angular_velocity}; }
  // Sizes the arrays; the contents may be lost.
  void grow(std::size_t items, std::size_t owned) {
    position.resize(whole(items)), velocity.resize(whole(items));
    if (rotates) angular_velocity.resize(whole(items));
    if (!implicit) return;
    acceleration.resize(owned);
    if (rotates) angular_acceleration.resize(owned);
  }
  // Sizes the arrays; the contents may be lost.
  void trim(cudaStream_t stream) {
    for (DeviceArray<Vec4>* array : motion()) array->trim(0, stream);
    acceleration.trim(0, stream), angular_acceleration.trim(0, stream);
  }
  std::size_t bytes() const {
    return position.bytes() + velocity.bytes() + angular_velocity.bytes() + acceleration.bytes() +
           angular_acceleration.bytes();
  }
  // Sizes are multiples of this, so that a warp's values of any type, and halves of an array, begin and end
  // at 32 B sectors.
  static constexpr std::size_t whole(std::size_t n) { return (n + 31) / 32 * 32; }
};

// Particles in mixed precision, between two lists. Arrays of their own are in the `DeviceArena` or, where
// particles rotate, alias arrays of values at an instant; double-buffered ones alias the second arrays of the
// state, which are not needed meanwhile.
struct MixedArrays {
  DeviceArray<MixedFraction> fraction;
  DeviceArray<MixedRest> rest;
  DeviceArray<MixedSpinRest> spin_rest;

  MixedViews views(SecondArrays& second);
};

// to[i] = from[order[i]] for the arrays that both have; without an order to[i] = from[i].
struct ReorderItem {
  ParticleViews from, to;
  const Index* order;

  SCREE_HD void operator()(Index i) const {
    const Index k = order != nullptr ? order[i] : i;
    const auto copy = [&](auto* new_values, const auto* values) {
      if (new_values != nullptr && values != nullptr) new_values[i] = values[k];
    };
    for_each_array<kAllArrays | kOptionalArrays>(copy, to, from);
  }
};

// Moves particle order[i] to i for i = 0 ... n - 1. now: arrays with a counterpart in `second` are swapped
// with it; the others are copied there and back, as many at a time as the memory holds. in_run: a run of
// explicit steps is open, which reads no values at an instant before it writes all of them; those whose
// memory its steps use otherwise are left as they are.
void reorder(Device device, ParticleArrays& now, SecondArrays& second, const Index* order, Index n,
             bool in_run);

// Records of the particles from `first` on: position inside the periodic box, except for drifting ones.
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

// The records become the particles from `first` on.
struct ArrivalItem {
  const Particle* arriving;
  ParticleViews out;
  Index first;

  SCREE_HD void operator()(Index k) const { put_particle(out, first + k, arriving[k]); }
};

}  // namespace scree
