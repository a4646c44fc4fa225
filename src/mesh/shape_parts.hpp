// Subdivision of the circles of drums and screws.
#pragma once

#include "mesh/primitives.hpp"

namespace scree {

// Arcs around a drum, from lifter to lifter and under the lifters, each cut into equal parts; without
// lifters there is one arc, all around.
struct DrumArcs {
  Index segments, below;    // of an arc, and under a lifter
  Real angle, angle_below;  // of one part [rad]
  Real foot_angle;          // half the angle of a lifter [rad]
};
DrumArcs drum_arcs(const DrumShape& shape);

// Parts along a screw, and around its section.
struct ScrewParts {
  Index layers, core_segments, sector_segments, radial_segments;
};
ScrewParts screw_parts(const ScrewShape& shape);

}  // namespace scree
