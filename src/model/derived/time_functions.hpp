// Functions of time from the deck.
#pragma once

#include "deck/deck.hpp"
#include "model/data/bodies.hpp"

namespace scree {

// Time function of a driver's motion. The default interpolation of its points is a natural cubic spline.
// Throws InputError for linear interpolation, whose velocity jumps.
TimeFunction build_motion(const DeckTable& table);
// Time function of a force, a torque or a motor's command. The default interpolation of its points is linear.
TimeFunction build_force(const DeckTable& table);

}  // namespace scree
