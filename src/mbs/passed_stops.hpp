// Joint limits that the start position has passed.
#pragma once

#include <string>
#include <vector>

#include "mbs/multibody.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// A joint limit of the model.
struct Stop {
  std::string title, joint;     // "joint limit 'end'", "hinge"
  Real lower, upper, exponent;  // as JointLimit's
  std::size_t number;           // among the system's joint forces
};
std::vector<Stop> stops_of(const Model& model);

// Warnings of the stops that are passed at t = 0 and push their joints out, one text for each, with the
// energy that they hold and the speed that it gives; a stop that loads hold there has none. start: with its
// accelerations; weight: of all bodies together [N]. Throws InputError where a stop holds more than a
// thousand times the energy of everything else: the motion at t = 0, springs, and the weights over the length
// scale.
std::vector<std::string> passed_stops(const RigidBodySystem& system, const std::vector<Stop>& stops,
                                      const MultibodyState& start, Real weight);

}  // namespace scree
