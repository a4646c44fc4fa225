// Rotation about z between a body's frame and the global frame.
#pragma once

#include <cmath>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// A = [c, -s, 0; s, c, 0; 0, 0, 1]; the default is the identity.
struct Rotation {
  Real cosine = 1, sine = 0;

  Rotation() = default;
  explicit Rotation(Real angle) : cosine(std::cos(angle)), sine(std::sin(angle)) {}  // [rad]

  // A v: from the body's frame to the global frame.
  Vec3 turn(Vec3 v) const { return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z}; }
};

// Velocity [m/s] at `arm` [m] from the centre of a body that rotates with `rate` [rad/s]: A' s for arm = A s.
inline Vec3 rotational_velocity(Real rate, Vec3 arm) { return {-rate * arm.y, rate * arm.x, 0}; }

}  // namespace scree
