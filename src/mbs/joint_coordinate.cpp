#include "mbs/joint_coordinate.hpp"

#include <utility>

#include "mbs/joints.hpp"
#include "model/derived/joint_coordinates.hpp"

namespace scree {

std::unique_ptr<Constraint> joint_coordinate(const std::string& title, const Model& model, int joint,
                                             std::optional<JointCoordinate> wanted,
                                             const BodyLayout& layout) {
  const JointCoordinate own = coordinate_of(title, model.joints[static_cast<std::size_t>(joint)], wanted);
  const std::unique_ptr<JointParts> parts = joint_parts(model, joint, layout);
  add_driver(own, ScalarFunction(0), *parts);
  std::vector<std::unique_ptr<Constraint>> rows = parts->take();
  return std::move(rows.front());
}

CoordinateInstant coordinate_at(const Constraint& coordinate, const BodyPoses& poses, const SystemInstant& at,
                                SparseTerm& gradient) {
  CoordinateInstant instant{at.time, 0, 0};
  coordinate.value(poses, at.time, &instant.value);
  gradient.begin();
  coordinate.jacobian(poses, 0, gradient);
  for (std::size_t i = 0; i < gradient.size(); ++i)
    instant.rate += gradient.value(i) * at.velocity[static_cast<std::size_t>(gradient.column(i))];
  return instant;
}

Real second_rate(const Constraint& coordinate, const BodyPoses& poses, const SystemInstant& at,
                 const SparseTerm& gradient) {
  const auto of = [](const std::vector<Real>& values, int i) { return values[static_cast<std::size_t>(i)]; };
  const Real one = 1;
  SparseTerm hessian;
  hessian.begin();
  coordinate.hessian(poses, &one, hessian);
  Real sum = 0;
  for (std::size_t i = 0; i < gradient.size(); ++i)
    sum += gradient.value(i) * of(*at.acceleration, gradient.column(i));
  for (std::size_t i = 0; i < hessian.size(); ++i)
    sum += hessian.value(i) * of(at.velocity, hessian.row(i)) * of(at.velocity, hessian.column(i));
  return sum;
}

}  // namespace scree
