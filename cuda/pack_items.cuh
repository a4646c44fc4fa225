// What one particle puts into a snapshot.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "particle_arrays.cuh"

namespace scree {

struct PackedParticle {
  GlobalId global_id;
  Real radius;
  Vec3 position, velocity, force;  // position inside the periodic box; force: contacts only
  Index contacts;
};

struct PackItem {
  ParticleViews in;
  const Index* order;     // by global id
  const Index* contacts;  // of ContactEnergyItem
  Vec3 gravity, box_min, period;
  PackedParticle* out;

  SCREE_HD void operator()(Index k) const {
    const Index i = order[k];
    ImageCount unused;
    const Vec4 x = in.position[i], v = in.velocity[i];
    out[k] = {id_of(in.row_key[i]),        x.w,        wrap(box_min, period, xyz(x), unused), xyz(v),
              in.force[i] - v.w * gravity, contacts[i]};
  }
};

}  // namespace scree
