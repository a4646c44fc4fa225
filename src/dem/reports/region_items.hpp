// Contributions of one particle to the sums over the particles in a region.
#pragma once

#include "base/hd.hpp"
#include "dem/particles/particle_fields.hpp"
#include "model/data/history_region.hpp"
#include "partition/subdomain.hpp"

namespace scree {

enum RegionTerm { kRegionNumber, kRegionMass, kRegionTerms };

// Number and mass of the particles whose centres are in the region, without escaped ones.
struct RegionItem {
  ParticleViews in;
  RegionBounds region;
  Vec3 box_min, period;  // of the domain; period: 0 along axes that are not periodic [m]
  struct Terms {
    Real value[kRegionTerms];
  };

  SCREE_HD Terms operator()(Index i) const {
    ImageCount unused;
    if (in.drifting[i] != 0 || !region.holds(wrap(box_min, period, xyz(in.position[i]), unused))) return {};
    return {{1, in.velocity[i].w}};
  }
};

}  // namespace scree
