// What sliding takes off a surface.
#pragma once

#include "base/types.hpp"

namespace scree {

// By Archard's law (J. Appl. Phys. 24, 1953) a normal force F that slides by s takes off the volume k/H F s,
// and loses mu F s: the volume per work of friction [1/Pa]. wear: k/H [1/Pa]; friction: mu, above 0. All that
// friction takes counts, its dashpot's work and that of unloading, too.
inline Real worn_per_work(Real wear, Real friction) { return wear / friction; }

}  // namespace scree
