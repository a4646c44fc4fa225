// Servos that start off their position and overshoot because a fixed step is too long.
#pragma once

#include <string>
#include <vector>

#include "mbs/multibody.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// A motor of type position in a model with fixed steps.
struct Servo {
  std::string name, joint;
  Real position, rate;  // prescribed at t = 0 [rad or m, per s]
  Real step;            // [s]
  std::size_t number;   // among the system's joint forces
};
// Empty with adaptive steps, which follow the error.
std::vector<Servo> servos_of(const Model& model);

// Warnings, one text each, of the servos whose first step may overshoot their position by far. start: with
// its accelerations.
std::vector<std::string> overshooting_servos(const RigidBodySystem& system, const std::vector<Servo>& servos,
                                             const MultibodyState& start);

}  // namespace scree
