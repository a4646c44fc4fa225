// Wear of a surface by sliding.
#pragma once

#include "base/types.hpp"

namespace scree {

// Worn volume per work of friction [1/Pa], by Archard's law (J. Appl. Phys. 24, 1953): a normal force F that
// slides by s wears off the volume k/H F s and dissipates mu F s. wear: k/H [1/Pa]; friction: mu, above 0.
// All dissipation of friction counts, including that of its dashpot and of unloading.
inline Real wear_per_work(Real wear, Real friction) { return wear / friction; }

}  // namespace scree
