// Halo: copies of particles near the other side of periodic sides (and, with several ranks, of other ranks').
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// One ghost: a copy of an owned item, moved by whole periods.
struct Ghost {
  Index source;       // local index of the original
  Vec3 shift;         // ghost position minus original position [m]
  std::int8_t image;  // number of the shift among the 27, 13 for none
};

inline constexpr std::int8_t kNoShift = 13;

// What decides which images of a point lie near the box.
struct HaloBox {
  Vec3 min, max;  // of the space [m]
  Vec3 period;    // [m], 0 along axes that are not periodic
  Real width;     // [m]
};

// Shifts by 0, +1 and -1 periods along one axis that bring x to within width of [min, max]; returns how many.
SCREE_HD int axis_shifts(Real x, Real min, Real max, Real period, Real width, int (&out)[3]) {
  int n = 0;
  out[n++] = 0;
  if (period == 0) return n;
  if (x + period <= max + width) out[n++] = 1;
  if (x - period >= min - width) out[n++] = -1;
  return n;
}

// Calls visit(shift [m], image) for each image of p but p itself that lies within the width of the box.
template <class Visit>
SCREE_HD void for_each_ghost(const HaloBox& box, Vec3 p, const Visit& visit) {
  int sx[3], sy[3], sz[3];
  const int nx = axis_shifts(p.x, box.min.x, box.max.x, box.period.x, box.width, sx);
  const int ny = axis_shifts(p.y, box.min.y, box.max.y, box.period.y, box.width, sy);
  const int nz = axis_shifts(p.z, box.min.z, box.max.z, box.period.z, box.width, sz);
  for (int a = 0; a < nz; ++a)
    for (int b = 0; b < ny; ++b)
      for (int c = 0; c < nx; ++c) {
        const int image = (sz[a] + 1) * 9 + (sy[b] + 1) * 3 + sx[c] + 1;
        if (image == kNoShift) continue;
        visit(Vec3{sx[c] * box.period.x, sy[b] * box.period.y, sz[a] * box.period.z},
              static_cast<std::int8_t>(image));
      }
}

// Refreshes one ghost's copy of a field; ghosts stand at field[first_ghost ...].
template <class T>
struct HaloItem {
  const Ghost* ghosts;
  T* field;
  Index first_ghost;

  SCREE_HD void operator()(Index g) const { field[first_ghost + g] = field[ghosts[g].source]; }
};

// The same for its position, which is moved by the ghost's shift.
struct HaloPositionItem {
  const Ghost* ghosts;
  Vec4* position;
  Index first_ghost;

  SCREE_HD void operator()(Index g) const {
    const Ghost ghost = ghosts[g];
    const Vec4 p = position[ghost.source];
    position[first_ghost + g] = vec4(xyz(p) + ghost.shift, p.w);
  }
};

// exchange_halo: finds the ghosts that lie within `width` [m] of the box, for originals at `position`.
std::vector<Ghost> exchange_halo(const Subdomain& subdomain, const Space& space,
                                 std::span<const Vec4> position, Real width);

// update_halo: refreshes the ghosts' copies of a field.
void update_halo(std::span<const Ghost> ghosts, std::span<Vec4> field, Index first_ghost);
// The same for positions.
void update_halo_positions(std::span<const Ghost> ghosts, std::span<Vec4> position, Index first_ghost);

}  // namespace scree
