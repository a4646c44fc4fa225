// Rows of the neighbour list, and the layout of the items that they refer to.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "dem/search/surface_rows.hpp"

namespace scree {

// Row i holds every item that can touch particle i before the list expires, and the surfaces near it. Rows of
// particles outside the search are empty.
struct NeighborList {
  std::vector<Index> offsets, neighbors;  // [owned + 1], [entries]
  SurfaceRows surfaces;
  Real skin = 0;  // search distance beyond contact [m]
};

// Layout of the items in the store: owned particles, of which the first `active` are in the search, then
// ghosts.
struct ItemLayout {
  Index owned = 0, active = 0, items = 0;
};

}  // namespace scree
