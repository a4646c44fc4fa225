// Orientations as unit quaternions, and their steps. + - x / alone: the same bits on CPU and GPU.
#pragma once

#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"

namespace scree {

// Turns from the body's frame to the global one; (1, 0, 0, 0) turns nothing.
struct alignas(16) Quaternion {
  Real w = 1, x = 0, y = 0, z = 0;
};

SCREE_HD Real dot(const Quaternion& a, const Quaternion& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}
// a b: the turn b, then the turn a.
SCREE_HD Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
SCREE_HD Quaternion operator*(Real s, const Quaternion& q) { return {s * q.w, s * q.x, s * q.y, s * q.z}; }

// A vector of the body's frame in the global one.
SCREE_HD Vec3 turned(const Quaternion& q, Vec3 a) {
  const Vec3 u{q.x, q.y, q.z}, b = Real(2) * cross(u, a);
  return a + q.w * b + cross(u, b);
}

// To length 1 from a length off by e: to e^2.
SCREE_HD Quaternion renormalised(const Quaternion& q) { return ((3 - dot(q, q)) / 2) * q; }

// The orientation after a step of h [s] with the angular velocity of its middle [rad/s], in the global frame:
// Cayley's form, dq = (1 - u.u, 2 u) / (1 + u.u), u = h w / 4, of exp(h w / 2). It keeps the length, and its
// angle, 4 atan(|u|), is short of h |w| by (h |w|)^3 / 48: of second order, as the step is.
SCREE_HD Quaternion turned_by(const Quaternion& q, Vec3 middle_spin, Real h) {
  const Vec3 u = (h / 4) * middle_spin;
  const Real square = dot(u, u), scale = reciprocal(1 + square), twice = 2 * scale;
  const Quaternion turn{(1 - square) * scale, twice * u.x, twice * u.y, twice * u.z};
  return renormalised(turn * q);
}

}  // namespace scree
