#include "mbs/joint_parts.hpp"

#include "model/derived/connections.hpp"

namespace scree {

std::unique_ptr<JointParts> joint_parts(const Model& model, int joint, const BodyLayout& layout) {
  const Joint& own = model.joints[static_cast<std::size_t>(joint)];
  return between(model, own.body) == BodyKind::spatial ? spatial_parts(own, joint, layout)
                                                       : planar_parts(own, layout);
}

}  // namespace scree
