// Joint limits that the start position violates.
#pragma once

#include <string>
#include <vector>

#include "mbs/multibody.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// A joint limit of the model.
struct Stop {
  std::string title, joint;     // "joint limit 'end'", "pin"
  Real lower, upper, exponent;  // as in JointLimit
  std::size_t number;           // among the system's joint forces
};
std::vector<Stop> stops_of(const Model& model);

// Warnings, one text each, of the limits that are violated at t = 0 and push their joints back, with the
// stored energy and the resulting speed; a limit held there by loads is not reported. start: with its
// accelerations; weight: of all bodies together [N]. Throws InputError where a limit stores more than a
// thousand times the energy of everything else: the motion at t = 0, springs, and the weights times the
// length scale.
std::vector<std::string> violated_limits(const RigidBodySystem& system, const std::vector<Stop>& stops,
                                         const MultibodyState& start, Real weight);

}  // namespace scree
