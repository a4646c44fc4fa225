// The domain as boxes: tests of positions against its sides.
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
// The allowed positions at t = 0: open_box, extended across periodic sides by the number of periods for which
// a position can be wrapped exactly.
Box start_box(const Space& space);

}  // namespace scree
