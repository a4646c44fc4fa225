#include <fmt/format.h>

#include <string>
#include <utility>

#include "base/error.hpp"
#include "mbs/joint_parts.hpp"

namespace scree {

namespace {

class PlanarParts final : public JointParts {
 public:
  PlanarParts(const Joint& joint, const BodyLayout& layout)
      : name_(joint.name),
        pair_(point_pair(layout, joint.body, joint.point)),
        axis_(planar(joint.axis)),
        angle_offset_(joint.angle_offset) {}

  void coincident_points() override { add(coincidence_constraint(pair_)); }
  void point_on_axis() override { add(axis_constraint(pair_, perp(axis_), ScalarFunction(0))); }
  void same_orientation() override { add(angle_constraint(pair_, ScalarFunction(angle_offset_))); }
  void axes_parallel() override {}  // always true in the plane
  void point_on_plane() override { refuse(); }
  void axes_perpendicular() override { refuse(); }
  void perpendicular_cross_arms() override { refuse(); }
  void constant_velocity() override { refuse(); }
  void advance(Real, Real) override { refuse(); }
  void angle(ScalarFunction f) override { add(angle_constraint(pair_, std::move(f))); }
  void arm_angle(JointCoordinate, ScalarFunction) override { refuse(); }
  void displacement(ScalarFunction f) override { add(axis_constraint(pair_, axis_, std::move(f))); }
  void length(ScalarFunction f) override { add(length_constraint(pair_, std::move(f))); }

 private:
  [[noreturn]] void refuse() const {
    throw InputError(fmt::format("joint '{}': its type is for spatial bodies", name_));
  }

  std::string name_;
  PointPair pair_;
  Vec2 axis_;
  Real angle_offset_;
};

}  // namespace

std::unique_ptr<JointParts> planar_parts(const Joint& joint, const BodyLayout& layout) {
  return std::make_unique<PlanarParts>(joint, layout);
}

}  // namespace scree
