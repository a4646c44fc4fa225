// Texts on velocities at t = 0 that joints and drivers determine.
#pragma once

#include <string>
#include <vector>

#include "mbs/rigid_body_system.hpp"

namespace scree {

// The deck keys and their values, with all digits, with which the bodies start with the velocities `to`
// instead of `from`: "bodies.crank.velocity = [0.0, 1.25], bodies.crank.angular_velocity = 2.5". dimension:
// of the domain. Keys that the bodies of a row share are left out. Empty where no key is left.
std::string keys_to_set(const RigidBodySystem& system, const std::vector<Real>& from,
                        const std::vector<Real>& to, int dimension);

// The largest change, over the scales of the coordinates: "angular_velocity of body 'crank' (id 0) from 0.0
// to 2.5 rad/s". Empty where nothing changes.
std::string largest_change(const RigidBodySystem& system, const std::vector<Real>& from,
                           const std::vector<Real>& to);

}  // namespace scree
