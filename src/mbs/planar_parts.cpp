#include <utility>

#include "mbs/joint_parts.hpp"

namespace scree {

namespace {

class PlanarParts final : public JointParts {
 public:
  PlanarParts(const Joint& joint, const BodyLayout& layout)
      : pair_(point_pair(layout, joint.body, joint.point)),
        axis_(planar(joint.axis)),
        angle_offset_(joint.angle_offset) {}

  void points_meet() override { add(coincidence_constraint(pair_)); }
  void point_on_axis() override { add(axis_constraint(pair_, perp(axis_), ScalarFunction(0))); }
  void same_orientation() override { add(angle_constraint(pair_, ScalarFunction(angle_offset_))); }
  void angle(ScalarFunction f) override { add(angle_constraint(pair_, std::move(f))); }
  void displacement(ScalarFunction f) override { add(axis_constraint(pair_, axis_, std::move(f))); }
  void length(ScalarFunction f) override { add(length_constraint(pair_, std::move(f))); }

 private:
  PointPair pair_;
  Vec2 axis_;
  Real angle_offset_;
};

}  // namespace

std::unique_ptr<JointParts> planar_parts(const Joint& joint, const BodyLayout& layout) {
  return std::make_unique<PlanarParts>(joint, layout);
}

}  // namespace scree
