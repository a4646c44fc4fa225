// Velocities at t = 0 that joints and drivers fix: what is said of them.
#pragma once

#include <string>
#include <vector>

#include "mbs/rigid_body_system.hpp"

namespace scree {

// Which deck keys to set to what, with all digits, so that the bodies start with the velocities `to` where
// they have `from`: "bodies.crank.velocity = [0.0, 1.25], bodies.crank.angular_velocity = 2.5". dimension: of
// the space. Bodies of a row share their keys: these are left out. Empty where no key is left.
std::string keys_to_set(const RigidBodySystem& system, const std::vector<Real>& from,
                        const std::vector<Real>& to, int dimension);

// The largest change, over the scales of the coordinates: "angular_velocity of body 'crank' (id 0) from 0.0
// to 2.5 rad/s". Empty where nothing changes.
std::string largest_change(const RigidBodySystem& system, const std::vector<Real>& from,
                           const std::vector<Real>& to);

}  // namespace scree
