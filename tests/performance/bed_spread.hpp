// Spheres of many sizes in a periodic box, for the cost of a spread of sizes.
#pragma once

#include <cstdint>

#include "model/data/model.hpp"

namespace scree {

// Compressed spheres, nearly at rest, without gravity, in a box that is periodic along all axes. The smallest
// have the diameter 1 and the mass 1, the largest the diameter `spread`; the density is the same for all, and
// in equal intervals of the logarithm of the radius they have equal masses. particles: a multiple of
// kTileParticles; a tile with this many is relaxed first, which takes about a minute, and repeated.
Model spread_box(Real spread, std::int64_t particles);

}  // namespace scree
