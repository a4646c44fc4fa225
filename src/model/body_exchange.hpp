// What crosses between the multibody side and the particle side.
#pragma once

#include <array>
#include <vector>

#include "base/rotation.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Motion of one body at one instant, global frame.
struct BodyMotion {
  Vec3 position;              // of the centre of mass [m]
  Vec3 velocity;              // [m/s]
  Real angle = 0;             // about z [rad]
  Real angular_velocity = 0;  // about z [rad/s]
};

// Position [m] and velocity [m/s] of a point fixed to a body.
struct PointMotion {
  Vec3 position, velocity;
};

inline PointMotion point_motion(const BodyMotion& body, Vec3 offset) {
  if (offset.x == 0 && offset.y == 0) return {body.position + offset, body.velocity};  // most shapes
  const Vec3 arm = Rotation(body.angle).turn(offset);
  return {body.position + arm, body.velocity + turning_velocity(body.angular_velocity, arm)};
}

// Contact wrench on one body.
struct BodyWrench {
  Vec3 force;   // [N]
  Vec3 torque;  // about the centre of mass [N m]
};

// Minus the derivatives of the contact wrench on a body with respect to its own motion. Symmetric 6x6 blocks,
// rows and columns (x, y, z, rx, ry, rz), upper triangle row by row: -d(force, torque)/d(position, rotation)
// and -d(force, torque)/d(velocity, angular velocity).
struct WrenchStiffness {
  int body = 0;
  std::array<Real, 21> stiffness{};  // [N/m, N/rad, N m/rad]
  std::array<Real, 21> damping{};    // the same times [s]
};

// What a Newton iteration of the bodies needs of their contacts.
struct ContactWrenches {
  std::vector<BodyWrench> wrench;          // per body
  std::vector<WrenchStiffness> stiffness;  // of bodies that are touched, no body twice
};

// Slot of (row, column), row <= column, in the packed upper triangle of a 6x6 block.
constexpr int packed6(int row, int column) { return row * 6 - row * (row - 1) / 2 + (column - row); }

// Adds J^T block J to a packed 6x6 matrix, J = [1, -arm x] the motion of a point at `arm` from the centre.
inline void add_point_block(std::array<Real, 21>& packed, const Sym3& block, Vec3 arm) {
  const Vec3 rows[6] = {{1, 0, 0},          {0, 1, 0},          {0, 0, 1},
                        {0, -arm.z, arm.y}, {arm.z, 0, -arm.x}, {-arm.y, arm.x, 0}};
  for (int i = 0; i < 6; ++i) {
    const Vec3 image = block * rows[i];
    for (int j = i; j < 6; ++j) packed[static_cast<std::size_t>(packed6(i, j))] += dot(image, rows[j]);
  }
}

// Adds a force that acts at `arm` [m] from the centre of mass.
inline void add_point_force(BodyWrench& wrench, Vec3 force, Vec3 arm) {
  wrench.force += force;
  wrench.torque += cross(arm, force);
}

// Adds minus that force's derivatives with respect to the point's position and velocity. The change of the
// arm under the force itself is left out: it is not definite.
inline void add_point_stiffness(WrenchStiffness& sum, Vec3 arm, const Sym3& stiffness, const Sym3& damping) {
  add_point_block(sum.stiffness, stiffness, arm);
  add_point_block(sum.damping, damping, arm);
}

}  // namespace scree
