// Particles on the device: the arrays of ParticleStore, twice, so that sorting, explicit and implicit steps
// can read one and write the other.
#pragma once

#include "dem/particle_store.hpp"
#include "device.cuh"

namespace scree {

// position, velocity, material and row_key hold all items, the others the owned particles.
struct ParticleArrays {
  DeviceArray<Vec4> position, velocity;  // x, y, z, radius [m]; x, y, z [m/s], mass [kg]
  DeviceArray<int> material;
  DeviceArray<std::int64_t> row_key;  // see row_key()
  DeviceArray<Vec3> acceleration, force;
  DeviceArray<Real> contact_loss, loss_power, integrator_loss;
  DeviceArray<ImageCount> image;
  DeviceArray<std::uint8_t> drifting;

  // Room for so many items and particles; the first `keep` items stay.
  void grow(std::size_t items, std::size_t owned, std::size_t keep, cudaStream_t stream) {
    position.grow(items, keep, stream), velocity.grow(items, keep, stream);
    material.grow(items, keep, stream), row_key.grow(items, keep, stream);
    keep = std::min(keep, owned);
    acceleration.grow(owned, keep, stream), force.grow(owned, keep, stream);
    contact_loss.grow(owned, keep, stream), loss_power.grow(owned, keep, stream);
    integrator_loss.grow(owned, keep, stream), image.grow(owned, keep, stream),
        drifting.grow(owned, keep, stream);
  }
};

// Orders the entries of a neighbour list's row, by global id and then by image, whatever the local indices
// are.
SCREE_HD std::int64_t row_key(GlobalId id, std::int8_t image) { return id * 27 + image; }
SCREE_HD GlobalId id_of(std::int64_t row_key) { return row_key / 27; }

// The arrays as plain pointers, for items.
struct ParticleViews {
  Vec4 *position, *velocity;
  int* material;
  std::int64_t* row_key;
  Vec3 *acceleration, *force;
  Real *contact_loss, *loss_power, *integrator_loss;
  ImageCount* image;
  std::uint8_t* drifting;
};

inline ParticleViews views_of(ParticleArrays& a) {
  return {a.position.data(),        a.velocity.data(), a.material.data(),     a.row_key.data(),
          a.acceleration.data(),    a.force.data(),    a.contact_loss.data(), a.loss_power.data(),
          a.integrator_loss.data(), a.image.data(),    a.drifting.data()};
}

// to[i] = from[order[i]].
struct ReorderItem {
  ParticleViews from, to;
  const Index* order;

  SCREE_HD void operator()(Index i) const {
    const Index k = order[i];
    to.position[i] = from.position[k], to.velocity[i] = from.velocity[k];
    to.material[i] = from.material[k], to.row_key[i] = from.row_key[k];
    to.acceleration[i] = from.acceleration[k], to.force[i] = from.force[k];
    to.contact_loss[i] = from.contact_loss[k], to.loss_power[i] = from.loss_power[k];
    to.integrator_loss[i] = from.integrator_loss[k];
    to.image[i] = from.image[k], to.drifting[i] = from.drifting[k];
  }
};

// Records of the particles from `first` on: position inside the periodic box, but for those that drift.
struct RecordItem {
  ParticleViews in;
  Index first;
  Vec3 box_min, period;
  ParticleRecord* out;

  SCREE_HD void operator()(Index k) const {
    const Index i = first + k;
    ParticleRecord r;
    r.global_id = id_of(in.row_key[i]);
    r.image = in.image[i];
    r.position = xyz(in.position[i]);
    r.velocity = xyz(in.velocity[i]);
    r.acceleration = in.acceleration[i], r.force = in.force[i];
    r.contact_loss = in.contact_loss[i], r.loss_power = in.loss_power[i];
    r.integrator_loss = in.integrator_loss[i];
    r.drifting = in.drifting[i] != 0;
    if (!r.drifting) r.position = wrap(box_min, period, r.position, r.image);
    out[k] = r;
  }
};

}  // namespace scree
