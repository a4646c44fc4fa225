// What joints and drivers are made of, in the plane and in space.
#pragma once

#include <memory>
#include <vector>

#include "mbs/constraints.hpp"
#include "mbs/measure.hpp"
#include "model/data/body_layout.hpp"
#include "model/data/model.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

// Rows between the two bodies of one joint, in the order in which they are asked for. A joint has a point and
// an axis on either body, that of the first body leading. What holds by itself in the plane has no row there.
class JointParts {
 public:
  virtual ~JointParts() = default;

  virtual void points_meet() = 0;
  // The second body's point stays on the first one's axis.
  virtual void point_on_axis() = 0;
  // No relative rotation.
  virtual void same_orientation() = 0;

  // In space alone. The second body's point stays in the plane across the first one's axis; the axes of
  // either body, and the arms of universal joints: x of the first marker, y of the second.
  virtual void point_on_plane() = 0;
  virtual void axes_parallel() = 0;
  virtual void axes_perpendicular() = 0;
  virtual void arms_perpendicular() = 0;
  // w_1 about z_1 equals w_2 about z_2.
  virtual void equal_spins() = 0;
  // The displacement along the axis is `start` and `lead` in every turn [m].
  virtual void advance(Real lead, Real start) = 0;

  // A coordinate of the joint is f: the angle of the second body less that of the first [rad], the
  // displacement of the second point along the axis, the distance of the two points [m]; in space alone
  // angle_1 or angle_2 of a universal joint.
  virtual void angle(ScalarFunction f) = 0;
  virtual void arm_angle(JointCoordinate angle, ScalarFunction f) = 0;
  virtual void displacement(ScalarFunction f) = 0;
  virtual void length(ScalarFunction f) = 0;

  std::vector<std::unique_ptr<Constraint>> take() { return std::move(rows_); }

 protected:
  void add(std::unique_ptr<Constraint> row) { rows_.push_back(std::move(row)); }

 private:
  std::vector<std::unique_ptr<Constraint>> rows_;
};

// By the kind of the joint's bodies. joint: its number in the model.
std::unique_ptr<JointParts> joint_parts(const Model& model, int joint, const BodyLayout& layout);
std::unique_ptr<JointParts> planar_parts(const Joint& joint, const BodyLayout& layout);
std::unique_ptr<JointParts> spatial_parts(const Joint& joint, int number, const BodyLayout& layout);
// An angle of a joint in space. number: of the joint, as of joint_parts.
std::unique_ptr<Measure> joint_angle(const Joint& joint, int number, JointCoordinate angle,
                                     const BodyLayout& layout);
// By which SpatialMotion::counted_angle knows it: a joint has two at most.
int angle_number(int joint, JointCoordinate angle);

}  // namespace scree
