#include "mbs/joints.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/error.hpp"

namespace scree {

void add_joint(const Joint& joint, bool driven, JointParts& parts) {
  switch (joint.kind) {
    case JointKind::revolute:
      parts.points_meet();
      break;
    case JointKind::fixed:
      parts.points_meet();
      parts.same_orientation();
      break;
    case JointKind::translational:
      parts.point_on_axis();
      parts.same_orientation();
      break;
    case JointKind::distance:
      if (!(joint.distance > 0)) {
        throw InputError(fmt::format("joint '{}': distance {} m is not allowed, it must be positive",
                                     joint.name, joint.distance));
      }
      // A driver's row replaces the joint's.
      if (!driven) parts.length(ScalarFunction(joint.distance));
      break;
  }
}

void add_driver(const std::string& title, const Joint& joint, ScalarFunction motion, JointParts& parts) {
  switch (joint.kind) {
    case JointKind::revolute:
      parts.angle(std::move(motion));
      break;
    case JointKind::translational:
      parts.displacement(std::move(motion));
      break;
    case JointKind::distance:
      parts.length(std::move(motion));
      break;
    case JointKind::fixed:
      throw InputError(
          fmt::format("{}: joint '{}' is fixed and has nothing to drive; allowed are revolute, "
                      "translational and distance joints",
                      title, joint.name));
  }
}

}  // namespace scree
