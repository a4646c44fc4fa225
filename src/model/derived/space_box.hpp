// The space as boxes: what lies inside it, and what beyond which of its sides.
#pragma once

#include "base/box.hpp"
#include "model/data/model.hpp"

namespace scree {

// The sides that are not periodic; the others, and z in 2D, are at infinity.
Box open_box(const Space& space);
// The sides that are periodic; the others are at infinity.
Box periodic_box(const Space& space);
// The sides that are walls; the others are at infinity.
Box wall_box(const Space& space);
// Where something may be at t = 0: as open_box, but with periodic sides so many periods away as a place in
// the periodic space can be told.
Box start_box(const Space& space);

}  // namespace scree
