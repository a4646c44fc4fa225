// Data exchanged between the multibody side and the particle side.
#pragma once

#include <array>
#include <vector>

#include "base/rotation.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/choices.hpp"
#include "model/data/bodies.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

// Motion of one body at one instant, in the global frame. Planar bodies have angle and angular_velocity,
// spatial bodies orientation and spin.
struct BodyMotion {
  Vec3 position;              // of the centre of mass [m]
  Vec3 velocity;              // [m/s]
  Real angle = 0;             // about z [rad]
  Real angular_velocity = 0;  // about z [rad/s]
  BodyKind kind = BodyKind::planar;
  Quaternion orientation{};
  Vec3 spin{};  // angular velocity in the body's frame [rad/s]
};

inline BodyMotion start_motion(const Body& body) {
  return {body.position, body.velocity,    body.angle, body.angular_velocity,
          body.kind,     body.orientation, body.spin};
}

// Position [m] and velocity [m/s] of a point fixed to a body.
struct PointMotion {
  Vec3 position, velocity;
};

// Offset in the body's frame, transformed to the global frame [m].
inline Vec3 body_arm(const BodyMotion& body, Vec3 offset) {
  if (body.kind == BodyKind::spatial) return rotation_matrix(body.orientation) * offset;
  if (offset.x == 0 && offset.y == 0) return offset;  // true for most shapes
  return Rotation(body.angle).turn(offset);
}

// Orientation of the body's frame, for either kind of body.
inline Quaternion orientation(const BodyMotion& body) {
  return body.kind == BodyKind::spatial ? body.orientation : exponential({0, 0, body.angle});
}

// Angular velocity in the global frame [rad/s].
inline Vec3 global_spin(const BodyMotion& body) {
  if (body.kind == BodyKind::spatial) return rotation_matrix(body.orientation) * body.spin;
  return {0, 0, body.angular_velocity};
}

// Rotation from one instant to a later one, in the global frame; less than half a revolution for spatial
// bodies [rad].
inline Vec3 rotation_between(const BodyMotion& before, const BodyMotion& after) {
  if (after.kind == BodyKind::planar) return {0, 0, after.angle - before.angle};
  return rotation_matrix(before.orientation) *
         rotation_vector(conjugate(before.orientation) * after.orientation);
}

inline PointMotion point_motion(const BodyMotion& body, Vec3 offset) {
  const Vec3 arm = body_arm(body, offset);
  if (body.kind == BodyKind::spatial)
    return {body.position + arm, body.velocity + cross(global_spin(body), arm)};
  return {body.position + arm, body.velocity + rotational_velocity(body.angular_velocity, arm)};
}

// Contact wrench on one body, or on a wall with a pose.
struct BodyWrench {
  Vec3 force;           // [N]
  Vec3 torque;          // about the centre of mass [N m]
  Real belt_power = 0;  // power of friction on a wall with a tangential surface velocity [W]

  BodyWrench& operator+=(const BodyWrench& other) {
    force += other.force, torque += other.torque, belt_power += other.belt_power;
    return *this;
  }
};

// Negative derivatives of the contact wrench on a body with respect to its own motion: -d(force,
// torque)/d(position, rotation) and -d(force, torque)/d(velocity, angular velocity). Symmetric 6x6 blocks
// with rows and columns (x, y, z, rx, ry, rz), upper triangle row by row.
struct WrenchStiffness {
  int body = 0;
  std::array<Real, 21> stiffness{};  // [N/m, N/rad, N m/rad]
  std::array<Real, 21> damping{};    // units of stiffness times [s]
};

// Coupling of two bodies in contact: the negative derivatives of the wrench on the first body with respect to
// the motion of the second, 6x6 blocks, row by row. Those of the wrench on the second body are the transposed
// blocks.
struct PairStiffness {
  int first = 0, second = 0;
  std::array<Real, 36> stiffness{}, damping{};
};

// Contact wrenches and their derivatives, for one Newton iteration of the bodies.
struct ContactWrenches {
  std::vector<BodyWrench> wrench;          // per body
  std::vector<WrenchStiffness> stiffness;  // for bodies with contacts, each body once
  std::vector<PairStiffness> pairs{};      // for pairs of bodies in contact, each pair once
};

// Index of (row, column), row <= column, in the packed upper triangle of a 6x6 block.
constexpr int packed6(int row, int column) { return row * 6 - row * (row - 1) / 2 + (column - row); }

}  // namespace scree
