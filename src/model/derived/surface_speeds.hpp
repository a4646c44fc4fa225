// Normal speeds of surfaces as far as the deck prescribes them: walls by their motions; bodies by drivers, by
// motors with a prescribed rate, and by motors with a known rate without load.
#pragma once

#include <vector>

#include "model/data/model.hpp"

namespace scree {

// For each material the largest normal speed of its surfaces [m/s]: of planes within the domain, of triangles
// and their convex and free edges, of the centres of shapes. Motion of a surface along itself does not count:
// belts, and drums without lifters. A driver or motor moves the bodies on its joint and those fixed to them,
// as if the joint's other body did not move.
std::vector<Real> surface_speeds(const Model& model);

// Largest absolute rate of a function from 0 to `end` [s] [its unit per s].
Real fastest_rate(const TimeFunction& function, Real end);

}  // namespace scree
