// What one particle puts into the history.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "dem/backend/reports.hpp"
#include "particle_arrays.cuh"

namespace scree {

// Writes a particle to the place that its id has among the sorted ids; the others write nothing.
struct TraceItem {
  ParticleViews in;
  const GlobalId* ids;
  Index count;
  Vec3 box_min, period;
  TracedParticle* out;

  SCREE_HD void operator()(Index i) const {
    const GlobalId id = id_of(in.row_key[i]);
    Index low = 0, high = count;  // its place is in [low, high)
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
