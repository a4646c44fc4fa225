// Functions of time from the deck.
#pragma once

#include "deck/deck.hpp"
#include "model/data/bodies.hpp"

namespace scree {

// From the table of a driver's motion; without an interpolation its points are joined by a clamped cubic
// spline.
TimeFunction build_motion(const DeckTable& table);
// From the table of a force, a torque or a motor's command; without an interpolation its points are joined by
// lines.
TimeFunction build_force(const DeckTable& table);

}  // namespace scree
