#include "mbs/joint_coordinate.hpp"

#include <utility>
#include <vector>

#include "mbs/joints.hpp"

namespace scree {

std::unique_ptr<Constraint> joint_coordinate(const std::string& title, const Joint& joint, const Model& model,
                                             const BodyLayout& layout) {
  const std::unique_ptr<JointParts> parts = joint_parts(model, joint, layout);
  add_driver(title, joint, ScalarFunction(0), *parts);
  std::vector<std::unique_ptr<Constraint>> rows = parts->take();
  return std::move(rows.front());
}

}  // namespace scree
