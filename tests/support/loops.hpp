// Closed loops of spatial revolute joints, whose constraints are redundant.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "model/derived/connections.hpp"
#include "support/spatial_run.hpp"

namespace scree {

constexpr Real kFall = 9.81;  // [m/s^2]

// A bar of 1 m and 1 kg from one point to another, its x along it, its z across.
inline Body bar(const std::string& name, Vec3 from, Vec3 to, Vec3 across) {
  Body body = spatial_body(name, 1, {1e-3, 1.0 / 12, 1.0 / 12}, Real(0.5) * (from + to));
  const Vec3 along = to - from;
  body.orientation = quaternion_of(transposed({along, cross(across, along), across}));
  return body;
}

// Axis: x, y or z.
inline Joint joint_along(const Model& model, JointKind kind, const std::string& name, int first, int second,
                         Vec3 point, Vec3 axis) {
  Joint joint = joint_at(kind, name, first, second, {}, {});
  const Vec3 across{axis.y, axis.z, axis.x};
  for (int i = 0; i < 2; ++i) {
    const int b = joint.body[i];
    joint.point[i] = to_body_point(model, b, point);
    joint.marker[i] = marker_along(to_body_direction(model, b, axis), to_body_direction(model, b, across));
  }
  return joint;
}

// N loops of four bars side by side (the IFToMM library's N-four-bar): N + 1 bars stand on the ground at x =
// 0 ... N, N couplers join their tops, which start with 1 m/s along x. With revolute joints everywhere each
// loop has three redundant rows; exact: each coupler has a spherical joint at its left and a cylindrical
// joint at its right end.
inline Model bars(int loops, bool exact) {
  Model model = spatial_model(-0.1);
  model.gravity = {0, -kFall, 0};
  if (!exact) model.integrator.redundant = RedundantRows::share;
  const Vec3 z{0, 0, 1};
  for (int i = 0; i <= loops; ++i) {
    const Real x = i;
    Body rod = bar("rod." + std::to_string(i), {x, 0, 0}, {x, 1, 0}, z);
    rod.velocity = {0.5, 0, 0}, rod.spin = {0, 0, -1};
    model.bodies.push_back(rod);
  }
  for (int i = 0; i < loops; ++i) {
    const Real x = i;
    Body coupler = bar("coupler." + std::to_string(i), {x, 1, 0}, {x + 1, 1, 0}, z);
    coupler.velocity = {1, 0, 0};
    model.bodies.push_back(coupler);
  }
  for (int i = 0; i <= loops; ++i) {
    const Real x = i;
    const std::string n = std::to_string(i);
    model.joints.push_back(joint_along(model, JointKind::revolute, "foot." + n, kGround, i, {x, 0, 0}, z));
    const int left = loops + i, right = loops + 1 + i;
    if (i > 0)
      model.joints.push_back(joint_along(model, exact ? JointKind::cylindrical : JointKind::revolute,
                                         "right." + n, i, left, {x, 1, 0}, z));
    if (i < loops)
      model.joints.push_back(joint_along(model, exact ? JointKind::spherical : JointKind::revolute,
                                         "left." + n, i, right, {x, 1, 0}, z));
  }
  return model;
}

// The motion of bars that stay parallel and of couplers between them, all of 1 m and 1 kg: theta'' = -k
// cos(theta) from x, by the Runge-Kutta method to round-off.
class FallingBars {
 public:
  FallingBars(int rods, int couplers)
      : k_(kFall * (rods / Real(2) + couplers) / (rods / Real(3) + couplers)) {}

  // Must be called for increasing instants [s].
  Real angle(Real t) {
    const int steps = static_cast<int>(std::ceil((t - time_) / 1e-3));
    const Real h = steps > 0 ? (t - time_) / steps : 0;
    for (int i = 0; i < steps; ++i) {
      const Real a1 = push(angle_), w2 = rate_ + h / 2 * a1, a2 = push(angle_ + h / 2 * rate_),
                 w3 = rate_ + h / 2 * a2, a3 = push(angle_ + h / 2 * w2), w4 = rate_ + h * a3,
                 a4 = push(angle_ + h * w3);
      angle_ += h / 6 * (rate_ + 2 * w2 + 2 * w3 + w4);
      rate_ += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    time_ = t;
    return angle_;
  }

 private:
  Real push(Real angle) const { return -k_ * std::cos(angle); }

  Real k_, angle_ = M_PI / 2, rate_ = -1, time_ = 0;
};

// Bricard's linkage: six links of 1 m along edges of a cube, the ground one of them, each revolute joint
// normal to the two links that it joins. One row is redundant in every position; exact: one joint is
// cylindrical.
inline Model bricard(bool exact) {
  Model model = spatial_model(-0.1);
  model.gravity = {0, -kFall, 0};
  if (!exact) model.integrator.redundant = RedundantRows::share;
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const Vec3 corner[6] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
  const Vec3 axis[6] = {y, z, x, y, z, x};
  for (int i = 0; i < 5; ++i)
    model.bodies.push_back(bar("link." + std::to_string(i), corner[i], corner[i + 1], axis[i]));
  for (int i = 0; i < 6; ++i)
    model.joints.push_back(joint_along(model, exact && i == 2 ? JointKind::cylindrical : JointKind::revolute,
                                       "hinge." + std::to_string(i), i == 0 ? kGround : i - 1,
                                       i == 5 ? kGround : i, corner[i], axis[i]));
  return model;
}

}  // namespace scree
