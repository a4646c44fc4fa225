#include "mbs/joints.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/error.hpp"

namespace scree {

void add_joint(const Joint& joint, bool rowless, JointParts& parts) {
  switch (joint.kind) {
    case JointKind::revolute:
      parts.coincident_points();
      parts.axes_parallel();
      break;
    case JointKind::fixed:
      parts.coincident_points();
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
      if (!rowless) parts.length(ScalarFunction(joint.distance));
      break;
    case JointKind::spherical:
      parts.coincident_points();
      break;
    case JointKind::cylindrical:
      parts.point_on_axis();
      parts.axes_parallel();
      break;
    case JointKind::screw:
      parts.point_on_axis();
      parts.axes_parallel();
      parts.advance(joint.lead, joint.advance);
      break;
    case JointKind::universal:
      parts.coincident_points();
      parts.perpendicular_cross_arms();
      break;
    case JointKind::constant_velocity:
      parts.coincident_points();
      parts.constant_velocity();
      break;
    case JointKind::planar:
      parts.point_on_plane();
      parts.axes_parallel();
      break;
    case JointKind::point_on_line:
      parts.point_on_axis();
      break;
    case JointKind::point_on_plane:
      parts.point_on_plane();
      break;
    case JointKind::parallel:
      parts.axes_parallel();
      break;
    case JointKind::perpendicular:
      parts.axes_perpendicular();
      break;
    case JointKind::orientation:
      parts.same_orientation();
      break;
  }
}

void add_driver(JointCoordinate coordinate, ScalarFunction motion, JointParts& parts) {
  switch (coordinate) {
    case JointCoordinate::angle:
      return parts.angle(std::move(motion));
    case JointCoordinate::angle_1:
    case JointCoordinate::angle_2:
      return parts.arm_angle(coordinate, std::move(motion));
    case JointCoordinate::displacement:
      return parts.displacement(std::move(motion));
    case JointCoordinate::length:
      return parts.length(std::move(motion));
  }
}

}  // namespace scree
