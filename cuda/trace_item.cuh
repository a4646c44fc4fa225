// Values of one particle for the history output.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "dem/backend/reports.hpp"
#include "particle_arrays.cuh"

namespace scree {

// Writes a particle to the position of its id among the sorted ids; particles not listed write nothing.
struct TraceItem {
  ParticleViews in;
  const GlobalId* ids;
  Index count;
  Vec3 box_min, period;
  TracedParticle* out;

  SCREE_HD void operator()(Index i) const {
    const GlobalId id = id_of(in.row_key[i]);
    Index low = 0, high = count;  // searched range of positions: low ... high - 1
    while (high - low > 1) {
      const Index middle = low + (high - low) / 2;
      (ids[middle] <= id ? low : high) = middle;
    }
    if (ids[low] != id) return;
    ImageCount unused;
    out[low] = {id, wrap(box_min, period, xyz(in.position[i]), unused), xyz(in.velocity[i]),
                in.angular_velocity == nullptr ? Vec3{} : xyz(in.angular_velocity[i])};
  }
};

}  // namespace scree
