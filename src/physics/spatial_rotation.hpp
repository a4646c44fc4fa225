// Orientations updated by rotation vectors, and their tangent operators; for bodies, on the host. Bruls,
// Cardona, Arnold, Mech. Mach. Theory 48 (2012).
#pragma once

#include <cmath>

#include "base/mat3.hpp"
#include "physics/orientation.hpp"

namespace scree {

inline Real norm(const Quaternion& p) { return std::sqrt(dot(p, p)); }
inline Quaternion normalized(const Quaternion& p) { return (1 / norm(p)) * p; }
inline Quaternion conjugate(const Quaternion& p) { return {p.w, -p.x, -p.y, -p.z}; }

// Matrix A of v_global = A v_body; p: unit quaternion.
inline Mat3 rotation_matrix(const Quaternion& p) {
  const Real w = p.w, x = p.x, y = p.y, z = p.z;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
}
// Unit quaternion of a rotation matrix, with w >= 0, after Shepperd, J. Guid. Control 1 (1978).
inline Quaternion quaternion_of(const Mat3& a) {
  const Real t[4] = {a.x.x + a.y.y + a.z.z, a.x.x, a.y.y, a.z.z};
  int largest = 0;
  for (int k = 1; k < 4; ++k)
    if (t[k] > t[largest]) largest = k;
  const Real sx = a.z.y - a.y.z, sy = a.x.z - a.z.x, sz = a.y.x - a.x.y;
  const Real xy = a.x.y + a.y.x, xz = a.x.z + a.z.x, yz = a.y.z + a.z.y;
  const Real own = 1 + 2 * t[largest] - t[0];
  const Quaternion p = largest == 0   ? Quaternion{1 + t[0], sx, sy, sz}
                       : largest == 1 ? Quaternion{sx, own, xy, xz}
                       : largest == 2 ? Quaternion{sy, xy, own, yz}
                                      : Quaternion{sz, xz, yz, own};
  return normalized(p.w < 0 ? Real(-1) * p : p);
}

// Unit quaternion of the rotation by |u| about u.
inline Quaternion exponential(Vec3 u) {
  const Real angle = norm(u), half = angle / 2;
  // sin(half) / angle; the next term of the series is below round-off.
  const Real scale =
      angle < Real(1e-3) ? (1 - angle * angle / 24 * (1 - angle * angle / 80)) / 2 : std::sin(half) / angle;
  return {std::cos(half), scale * u.x, scale * u.y, scale * u.z};
}
// Rotation vector of a unit quaternion, of length up to pi.
inline Vec3 rotation_vector(const Quaternion& p) {
  const Vec3 v{p.x, p.y, p.z};
  const Real sine = norm(v);
  if (sine == 0) return {};
  const Real half = p.w < 0 ? std::atan2(-sine, -p.w) : std::atan2(sine, p.w);
  return (2 * half / sine) * v;
}

// T^-1(u) = 1 + u~/2 + c u~^2, c = 1/f^2 - (1 + cos f) / (2 f sin f), f = |u|: derivative of u with respect
// to the orientation, in the body frame of exponential(u). |u| < 2 pi.
inline Mat3 inverse_tangent(Vec3 u) {
  const Real f = norm(u), f2 = f * f;
  const Real c = f < Real(0.03) ? (1 + f2 / 60 * (1 + f2 / 42)) / 12 : 1 / f2 - 1 / (2 * f * std::tan(f / 2));
  const Mat3 t = tilde(u);
  return identity3() + Real(0.5) * t + c * (t * t);
}

// Matrix D with D du = d(T^-1(u)) e, e constant: derivative of the inverse tangent.
//   D = -e~/2 - c ((u~ e)~ + u~ e~) + (c'/f) (u~^2 e) u^T
inline Mat3 inverse_tangent_change(Vec3 u, Vec3 e) {
  const Real f = norm(u), f2 = f * f;
  // c and c'/f by their series where the closed forms cancel.
  const bool small = f < Real(0.25);
  const Real tangent = std::tan(f / 2), sine = std::sin(f / 2);
  const Real c = small ? (1 + f2 / 60 * (1 + f2 / 42 * (1 + f2 / 40))) / 12 : 1 / f2 - 1 / (2 * f * tangent);
  const Real slope = small ? (1 + f2 / 21 * (1 + 3 * f2 / 80 * (1 + 10 * f2 / 297))) / 360
                           : (1 / (2 * f * tangent) + 1 / (4 * sine * sine) - 2 / f2) / f2;
  const Vec3 once = cross(u, e), twice = cross(u, once);
  const Mat3 turn = Real(-0.5) * tilde(e) - c * (tilde(once) + tilde(u) * tilde(e));
  return turn + outer(slope, twice, u);
}

// Magnus term of a rotation over a step of length h, h3 = h^3: the rotation vector of a motion with angular
// velocity w and its rate w', less the integral of w, is w x w' h^3 / 12 in the body frame.
inline Vec3 rotation_drift(Real h3, Vec3 w, Vec3 rate) { return (h3 / 12) * cross(w, rate); }

// Gyroscopic torque in the body frame, J w' = torque + gyroscopic_torque(J, w); it does no work.
inline Vec3 gyroscopic_torque(const Mat3& inertia, Vec3 w) { return cross(inertia * w, w); }
inline Real rotational_energy(const Mat3& inertia, Vec3 w) { return dot(w, inertia * w) / 2; }  // [J]

// `integrator_loss()` (time_stepping.hpp) of a rotation; torques: without the gyroscopic one [N m].
inline Real rotation_loss(const Mat3& inertia, Vec3 turn, Vec3 w0, Vec3 w1, Vec3 torque0, Vec3 torque1) {
  return dot(torque0 + torque1, turn) / 2 - (rotational_energy(inertia, w1) - rotational_energy(inertia, w0));
}

}  // namespace scree
