// What crosses between the multibody side and the particle side.
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

// Motion of one body at one instant, global frame. angle, angular_velocity: of a planar body; orientation,
// spin: of a spatial one.
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

// An offset in the body's frame, in the global one [m].
inline Vec3 body_arm(const BodyMotion& body, Vec3 offset) {
  if (body.kind == BodyKind::spatial) return rotation_matrix(body.orientation) * offset;
  if (offset.x == 0 && offset.y == 0) return offset;  // most shapes
  return Rotation(body.angle).turn(offset);
}

// Of the body's frame, of either kind.
inline Quaternion orientation(const BodyMotion& body) {
  return body.kind == BodyKind::spatial ? body.orientation : exponential({0, 0, body.angle});
}

// Angular velocity in the global frame [rad/s].
inline Vec3 global_spin(const BodyMotion& body) {
  if (body.kind == BodyKind::spatial) return rotation_matrix(body.orientation) * body.spin;
  return {0, 0, body.angular_velocity};
}

// Rotation from one instant to a later one, less than half a turn in space, in the global frame [rad].
inline Vec3 turn_between(const BodyMotion& before, const BodyMotion& after) {
  if (after.kind == BodyKind::planar) return {0, 0, after.angle - before.angle};
  return rotation_matrix(before.orientation) *
         rotation_vector(conjugate(before.orientation) * after.orientation);
}

inline PointMotion point_motion(const BodyMotion& body, Vec3 offset) {
  const Vec3 arm = body_arm(body, offset);
  if (body.kind == BodyKind::spatial)
    return {body.position + arm, body.velocity + cross(global_spin(body), arm)};
  return {body.position + arm, body.velocity + turning_velocity(body.angular_velocity, arm)};
}

// Contact wrench on one body, or on a wall that is placed.
struct BodyWrench {
  Vec3 force;            // [N]
  Vec3 torque;           // about the centre of mass [N m]
  Real slide_power = 0;  // of friction on a wall's surface that runs along itself [W]

  BodyWrench& operator+=(const BodyWrench& other) {
    force += other.force, torque += other.torque, slide_power += other.slide_power;
    return *this;
  }
};

// Minus the derivatives of the contact wrench on a body with respect to its own motion. Symmetric 6x6 blocks,
// rows and columns (x, y, z, rx, ry, rz), upper triangle row by row: -d(force, torque)/d(position, rotation)
// and -d(force, torque)/d(velocity, angular velocity).
struct WrenchStiffness {
  int body = 0;
  std::array<Real, 21> stiffness{};  // [N/m, N/rad, N m/rad]
  std::array<Real, 21> damping{};    // the same times [s]
};

// The same of two bodies that touch each other, of the wrench on the first one by the motion of the second:
// 6x6 blocks, row by row. Of that on the second one by the motion of the first they are the transposed ones.
struct PairStiffness {
  int first = 0, second = 0;
  std::array<Real, 36> stiffness{}, damping{};
};

// What a Newton iteration of the bodies needs of their contacts.
struct ContactWrenches {
  std::vector<BodyWrench> wrench;          // per body
  std::vector<WrenchStiffness> stiffness;  // of bodies that are touched, no body twice
  std::vector<PairStiffness> pairs{};      // of bodies that touch each other, no two of them twice
};

// Slot of (row, column), row <= column, in the packed upper triangle of a 6x6 block.
constexpr int packed6(int row, int column) { return row * 6 - row * (row - 1) / 2 + (column - row); }

}  // namespace scree
