#include "mbs/joint_parts.hpp"

#include "model/connections.hpp"

namespace scree {

std::unique_ptr<JointParts> joint_parts(const Model& model, const Joint& joint, const BodyLayout& layout) {
  return between(model, joint.body) == BodyKind::spatial ? spatial_parts(joint, layout)
                                                         : planar_parts(joint, layout);
}

}  // namespace scree
