// Scalar constraints C(q, t) = g(q) - f(t) = 0 between two planar bodies. Joints and drivers consist of
// them: f is constant in a joint and the prescribed motion in a driver.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mbs/body_poses.hpp"
#include "mbs/sparse_term.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

// One or two rows of Phi of one joint or driver. Notation: r_i, theta_i, w_i position, angle and spin of
// body i; a_i, d as in PairGeometry; e = d/|d|; lambda the multipliers of the rows.
class Constraint {
 public:
  virtual ~Constraint() = default;
  virtual int rows() const { return 1; }
  // C is an angle [rad]; otherwise it is a length [m].
  virtual bool is_angle() const { return false; }

  // The value C; c: [rows].
  virtual void value(const BodyPoses& poses, Real t, Real* c) const = 0;
  // The Jacobian C_q; its first row is `row` of Phi_q.
  virtual void jacobian(const BodyPoses& poses, int row, SparseTerm& out) const = 0;
  // (C_q^T lambda)_q.
  virtual void hessian(const BodyPoses& poses, const Real* lambda, SparseTerm& out) const = 0;
  // C_q q' = velocity_rhs, C_q q'' = acceleration_rhs; rhs: [rows].
  virtual void velocity_rhs(Real t, Real* rhs) const = 0;
  virtual void acceleration_rhs(const BodyPoses& poses, Real t, Real* rhs) const = 0;
  // Adds the force [N] on body 2 at its joint point, and the torque about that point [N m]: the reaction's
  // generalized force is -C_q^T lambda.
  virtual void add_reaction(const BodyPoses& poses, const Real* lambda, Vec3& force, Vec3& torque) const = 0;
  // Power that the prescribed motion feeds in [W]: -lambda C_q q' = -lambda f'.
  virtual Real power(Real t, const Real* lambda) const = 0;
};

// The points coincide: C = d. Two rows.
std::unique_ptr<Constraint> coincidence_constraint(const PointPair& pair);
// C = theta_2 - theta_1 - f(t).
std::unique_ptr<Constraint> angle_constraint(const PointPair& pair, ScalarFunction angle);
// C = u.d - f(t), u = A_1 axis; axis: unit vector in the frame of body 1.
std::unique_ptr<Constraint> axis_constraint(const PointPair& pair, Vec2 axis, ScalarFunction displacement);
// C = |d| - f(t).
std::unique_ptr<Constraint> length_constraint(const PointPair& pair, ScalarFunction length);

}  // namespace scree
