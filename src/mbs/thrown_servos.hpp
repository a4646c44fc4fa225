// Servos that start beside their position and are thrown off it by a fixed step that is too long.
#pragma once

#include <string>
#include <vector>

#include "mbs/multibody.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// A motor of type position in a model with fixed steps.
struct Servo {
  std::string name, joint;
  Real position, rate;  // wanted at t = 0 [rad or m, per s]
  Real step;            // [s]
  std::size_t number;   // among the system's joint forces
};
// Empty where steps adapt: these follow the error.
std::vector<Servo> servos_of(const Model& model);

// Warnings of the servos whose first step may throw them far off their position, one text for each. start:
// with its accelerations.
std::vector<std::string> thrown_servos(const RigidBodySystem& system, const std::vector<Servo>& servos,
                                       const MultibodyState& start);

}  // namespace scree
