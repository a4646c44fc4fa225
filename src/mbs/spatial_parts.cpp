#include <cmath>
#include <utility>

#include "mbs/joint_parts.hpp"
#include "mbs/spatial_constraints.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

// Axes of either marker in the frame of its body: x_i, y_i, z_i with the joint's axis along z.
class SpatialParts final : public JointParts {
 public:
  SpatialParts(const Joint& joint, int number, const BodyLayout& layout)
      : number_(number), pair_(spatial_pair(layout, joint.body, joint.point)) {
    for (int i = 0; i < 2; ++i) axes_[i] = transposed(rotation_matrix(joint.marker[i]));
  }

  void coincident_points() override { add(coincidence_constraint(pair_)); }
  void point_on_axis() override {
    add_displacement(0, ScalarFunction(0));
    add_displacement(1, ScalarFunction(0));
  }
  void point_on_plane() override { add_displacement(2, ScalarFunction(0)); }
  void same_orientation() override {
    add_perpendicular(0, 1);
    add_perpendicular(1, 2);
    add_perpendicular(2, 0);
  }
  void axes_parallel() override {
    add_perpendicular(0, 2);
    add_perpendicular(1, 2);
  }
  void axes_perpendicular() override { add_perpendicular(2, 2); }
  void perpendicular_cross_arms() override { add_perpendicular(0, 1); }
  // The sine of the difference between the rotations of the two bodies, each about its own axis.
  void constant_velocity() override {
    std::vector<WeightedPrimitive> terms;
    terms.push_back({1, dot1_primitive(pair_, axis(0, 0), axis(1, 1))});
    terms.push_back({-1, dot1_primitive(pair_, axis(0, 1), axis(1, 0))});
    add(primitive_constraint(sum_of_primitives(std::move(terms)), ScalarFunction(0)));
  }
  void advance(Real lead, Real start) override {
    std::vector<WeightedPrimitive> terms;
    terms.push_back({1, dot2_primitive(pair_, axis(0, 2))});
    terms.push_back({-lead / (2 * M_PI), measured(JointCoordinate::angle)});
    add(primitive_constraint(sum_of_primitives(std::move(terms)), ScalarFunction(start)));
  }
  void angle(ScalarFunction f) override { arm_angle(JointCoordinate::angle, std::move(f)); }
  void arm_angle(JointCoordinate angle, ScalarFunction f) override {
    add(primitive_constraint(measured(angle), std::move(f)));
  }
  void displacement(ScalarFunction f) override { add_displacement(2, std::move(f)); }
  void length(ScalarFunction f) override {
    add(primitive_constraint(distance_primitive(pair_), std::move(f)));
  }

  std::unique_ptr<PrimitiveFunction> measured(JointCoordinate angle) const {
    const auto between = [&](int i, int j) { return dot1_primitive(pair_, axis(0, i), axis(1, j)); };
    const int number = angle_number(number_, angle);
    if (angle == JointCoordinate::angle_1) return angle_primitive(between(1, 1), between(2, 1), number);
    if (angle == JointCoordinate::angle_2) return angle_primitive(between(0, 0), between(0, 2), number);
    return angle_primitive(between(0, 0), between(1, 0), number);
  }

 private:
  Vec3 axis(int body, int k) const { return row_of(axes_[body], k); }
  void add_displacement(int k, ScalarFunction f) {
    add(primitive_constraint(dot2_primitive(pair_, axis(0, k)), std::move(f)));
  }
  // Axis i of the first marker is perpendicular to axis j of the second one.
  void add_perpendicular(int i, int j) {
    add(primitive_constraint(dot1_primitive(pair_, axis(0, i), axis(1, j)), ScalarFunction(0)));
  }

  int number_;  // of the joint in the model
  SpatialPair pair_;
  Mat3 axes_[2];
};

}  // namespace

std::unique_ptr<JointParts> spatial_parts(const Joint& joint, int number, const BodyLayout& layout) {
  return std::make_unique<SpatialParts>(joint, number, layout);
}

std::unique_ptr<PrimitiveFunction> joint_angle(const Joint& joint, int number, JointCoordinate angle,
                                               const BodyLayout& layout) {
  return SpatialParts(joint, number, layout).measured(angle);
}

int angle_number(int joint, JointCoordinate angle) {
  return 2 * joint + (angle == JointCoordinate::angle_2 ? 1 : 0);
}

}  // namespace scree
