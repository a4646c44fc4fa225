// The space in which particles stay: the domain without the outlets. Shared by the CPU and CUDA backends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "partition/subdomain.hpp"
#include "physics/outlet_region.hpp"

namespace scree {

// Mark in the field `drifting` of particles that are to be removed.
inline constexpr std::uint8_t kRemoved = 3;

struct RemainingSpace {
  OpenBox box;           // sides of the domain that are not periodic
  Vec3 box_min, period;  // of the periodic box [m]; 0 along axes without a period
  int outlets = 0;
  OutletRegion outlet[kMostOutlets];

  RemainingSpace() = default;
  RemainingSpace(const Subdomain& subdomain, Vec3 space_min, std::span<const OutletRegion> regions)
      : box(subdomain.box()),
        box_min(space_min),
        period(subdomain.period()),
        outlets(static_cast<int>(regions.size())) {
    std::copy(regions.begin(), regions.end(), outlet);
  }

  // The first outlet that contains the point, or any of its images: p may be in any of them; -1: none.
  SCREE_HD int outlet_at(Vec3 p) const {
    if (outlets == 0) return -1;
    ImageCount image;
    const Vec3 q = wrap(box_min, period, p, image);
    for (int k = 0; k < outlets; ++k)
      if (outlet[k].contains(q)) return k;
    return -1;
  }
  SCREE_HD bool holds(Vec3 p) const { return box.inside(p) && outlet_at(p) < 0; }
};

}  // namespace scree
