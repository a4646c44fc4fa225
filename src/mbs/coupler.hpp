// A constraint between the coordinates of joints: gears, belts, racks and differentials.
#pragma once

#include <memory>

#include "mbs/constraints.hpp"
#include "model/data/model.hpp"

namespace scree {

// C = sum of k_i c_i - (its value at t = 0, with the bodies at `start`). The reported reaction is that on
// the first joint. Throws InputError for a joint without a coordinate.
std::unique_ptr<Constraint> make_coupler(const Coupler& coupler, const Model& model, const BodyLayout& layout,
                                         const BodyPoses& start);

}  // namespace scree
