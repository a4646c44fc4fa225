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

// exchange_halo: finds the ghosts that lie within `width` [m] of the box, for originals at `position`.
std::vector<Ghost> exchange_halo(const Subdomain& subdomain, const Space& space,
                                 std::span<const Vec4> position, Real width);

// update_halo: refreshes the ghosts' copies of a field; ghosts stand at field[first_ghost ...].
void update_halo(std::span<const Ghost> ghosts, std::span<Vec4> field, Index first_ghost);
// The same for positions, which are moved by the ghosts' shifts.
void update_halo_positions(std::span<const Ghost> ghosts, std::span<Vec4> position, Index first_ghost);

}  // namespace scree
