// How fast surfaces come at what they hit, as far as the deck prescribes it: walls by their motions, bodies
// by drivers, by motors with a prescribed rate, and by those whose rate without a load is known.
#pragma once

#include <vector>

#include "model/data/model.hpp"

namespace scree {

// Of each material, the fastest that a surface of it moves along a normal of its own [m/s]: of a plane within
// the space, of triangles and of their convex and open edges, of the centres of shapes. What runs or turns
// along itself counts nothing: belts, and drums without lifters. Of drivers and motors the bodies on their
// joints count, and those fixed to these, as if the other body of the joint were at rest.
std::vector<Real> surface_speeds(const Model& model);

// The largest rate of a function from 0 to `end` [s], either way [its unit per s].
Real fastest_rate(const TimeFunction& function, Real end);

}  // namespace scree
