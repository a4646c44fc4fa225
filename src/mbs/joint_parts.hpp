// Primitive constraints that joints and drivers consist of, in the plane and in space.
#pragma once

#include <memory>
#include <vector>

#include "mbs/constraints.hpp"
#include "mbs/primitive_function.hpp"
#include "model/data/body_layout.hpp"
#include "model/data/model.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

// Rows between the two bodies of one joint, in the order of the calls. A joint has a point and an axis on
// either body, the first body being the reference. Conditions that hold in the plane by themselves add no
// row there.
class JointParts {
 public:
  virtual ~JointParts() = default;

  virtual void coincident_points() = 0;
  // The second body's point stays on the axis of the first body.
  virtual void point_on_axis() = 0;
  // No relative rotation.
  virtual void same_orientation() = 0;

  // Spatial joints only. The second body's point stays in the plane normal to the first body's axis.
  // Conditions on the axes of both bodies, and on the cross arms of universal joints: x of the first marker,
  // y of the second.
  virtual void point_on_plane() = 0;
  virtual void axes_parallel() = 0;
  virtual void axes_perpendicular() = 0;
  virtual void perpendicular_cross_arms() = 0;
  // The spin w_1 about z_1 equals w_2 about z_2.
  virtual void constant_velocity() = 0;
  // The displacement along the axis is `start` plus `lead` per revolution [m].
  virtual void advance(Real lead, Real start) = 0;

  // A coordinate of the joint equals f: the angle of the second body less that of the first [rad], the
  // displacement of the second point along the axis, the distance of the two points [m]; of spatial joints
  // also angle_1 or angle_2 of a universal joint.
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

// Planar or spatial parts, by the kind of the joint's bodies. joint: its number in the model.
std::unique_ptr<JointParts> joint_parts(const Model& model, int joint, const BodyLayout& layout);
std::unique_ptr<JointParts> planar_parts(const Joint& joint, const BodyLayout& layout);
std::unique_ptr<JointParts> spatial_parts(const Joint& joint, int number, const BodyLayout& layout);
// An angle of a spatial joint. number: the joint's number in the model.
std::unique_ptr<PrimitiveFunction> joint_angle(const Joint& joint, int number, JointCoordinate angle,
                                               const BodyLayout& layout);
// Number of an angle in SpatialMotion::counted_angle: a joint has two at most.
int angle_number(int joint, JointCoordinate angle);

}  // namespace scree
