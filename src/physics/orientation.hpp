// Orientations as unit quaternions, and their time steps. Only + - x / are used, which have the same bits on
// CPU and GPU.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"

namespace scree {

// Rotation from the body frame to the global one; (1, 0, 0, 0) is the identity.
struct alignas(16) Quaternion {
  Real w = 1, x = 0, y = 0, z = 0;
};

SCREE_HD Real dot(const Quaternion& a, const Quaternion& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}
// a b: first the rotation b, then the rotation a.
SCREE_HD Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
SCREE_HD Quaternion operator*(Real s, const Quaternion& q) { return {s * q.w, s * q.x, s * q.y, s * q.z}; }

// Transforms a vector of the body frame to the global one.
SCREE_HD Vec3 rotated(const Quaternion& q, Vec3 a) {
  const Vec3 u{q.x, q.y, q.z}, b = Real(2) * cross(u, a);
  return a + q.w * b + cross(u, b);
}

// Normalizes a length that is off by e to an error of e^2.
SCREE_HD Quaternion renormalised(const Quaternion& q) { return ((3 - dot(q, q)) / 2) * q; }

// Orientation after a step of h [s] with the mid-step angular velocity [rad/s] in the global frame: the
// Cayley form dq = (1 - u.u, 2 u) / (1 + u.u), u = h w / 4, of exp(h w / 2). It preserves the length; its
// angle 4 atan(|u|) is smaller than h |w| by (h |w|)^3 / 48, second order like the step.
SCREE_HD Quaternion rotated_by(const Quaternion& q, Vec3 middle_spin, Real h) {
  const Vec3 u = (h / 4) * middle_spin;
  const Real square = dot(u, u), scale = reciprocal(1 + square), twice = 2 * scale;
  const Quaternion turn{(1 - square) * scale, twice * u.x, twice * u.y, twice * u.z};
  return renormalised(turn * q);
}

}  // namespace scree
