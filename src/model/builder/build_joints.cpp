// Joints and drivers.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "model/builder/build_parts.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/frames.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/time_functions.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

Vec3 global_axis(const DeckTable& table) {
  const Vec3 axis = table.has("axis") ? table.vector("axis") : Vec3{1, 0, 0};
  if (std::hypot(axis.x, axis.y) == 0 || axis.z != 0)
    table.fail("axis", "must not be 0 and must lie in the x-y plane");
  return (1 / norm(axis)) * axis;
}

Vec3 direction(const DeckTable& table, const char* key) {
  if (!table.has(key)) table.fail(key, "missing; between spatial bodies this type of joint needs it");
  return read_direction(table, key);
}

constexpr Real kSquare = 1e-9;  // cosine of axes that must be perpendicular

void check_square(const DeckTable& table, Vec3 axis, Vec3 second) {
  if (std::abs(dot(axis, second)) > kSquare)
    table.fail("second_axis", fmt::format("must be perpendicular to axis; the cosine between them is {:.3g}, "
                                          "allowed is {:g}",
                                          dot(axis, second), kSquare));
}

// Sets the frames of the joint on either body at t = 0, rows x, y, z; see Joint::marker.
void place_frames(const DeckTable& table, const Joint& joint, Mat3 (&frame)[2]) {
  frame[0] = frame[1] = identity3();
  switch (joint.kind) {
    case JointKind::fixed:
    case JointKind::orientation:
    case JointKind::spherical:
    case JointKind::distance:
      return;
    case JointKind::universal: {
      const Vec3 x = direction(table, "axis"), y = direction(table, "second_axis");
      check_square(table, x, y);
      frame[0] = frame[1] = {x, y, cross(x, y)};
      return;
    }
    case JointKind::perpendicular: {
      const Vec3 one = direction(table, "axis"), two = direction(table, "second_axis");
      check_square(table, one, two);
      frame[0] = frame_about(one), frame[1] = frame_about(two);
      return;
    }
    case JointKind::constant_velocity: {
      const Vec3 one = direction(table, "axis"), two = direction(table, "second_axis");
      if (dot(one, two) < 0 && norm(cross(one, two)) < kSquare)
        table.fail("second_axis", "must not point against axis");
      frame[0] = frame_about(one);
      frame[1] = rotated_frame(frame[0], one, two);
      return;
    }
    default:
      frame[0] = frame[1] = frame_about(direction(table, "axis"));
  }
}

constexpr Real kAligned = 1e-6;  // [rad]
constexpr Real kDegrees = 180 / std::numbers::pi_v<Real>;

// Throws InputError where the markers are misaligned. `wrong`: their misalignment [rad].
void check_aligned(const DeckTable& table, const std::string& must, Real wrong) {
  if (wrong <= kAligned) return;
  const std::string against =
      wrong > std::numbers::pi_v<Real> / 2 ? "; turn one of them by half a turn about its x axis" : "";
  table.fail("markers",
             fmt::format("{} at t = 0; they are off by {:.6g} degrees, allowed are {:.2g} degrees{}", must,
                         wrong * kDegrees, kAligned * kDegrees, against));
}

// The second frame, rotated to satisfy the joint's constraints exactly.
Mat3 aligned(const DeckTable& table, JointKind kind, const Mat3& one, const Mat3& two) {
  const auto square = [&](Vec3 a, Vec3 b, const char* must) {
    check_aligned(table, must, std::abs(angle_between(a, b) - std::numbers::pi_v<Real> / 2));
    const Vec3 across = b - dot(a, b) * a;
    return rotated_frame(two, b, (1 / norm(across)) * across);
  };
  switch (kind) {
    case JointKind::fixed:
    case JointKind::translational:
    case JointKind::orientation:
      check_aligned(table, "the axes of the two markers must be the same",
                    norm(rotation_vector(quaternion_of(one * transposed(two)))));
      return one;
    case JointKind::revolute:
    case JointKind::cylindrical:
    case JointKind::screw:
    case JointKind::planar:
    case JointKind::parallel:
      check_aligned(table, "the z axes of the two markers must point in the same direction",
                    angle_between(one.z, two.z));
      return rotated_frame(two, two.z, one.z);
    case JointKind::universal:
      return square(one.x, two.y,
                    "the first marker's x axis must be perpendicular to the second one's y axis");
    case JointKind::perpendicular:
      return square(one.z, two.z, "the z axes of the two markers must be perpendicular");
    case JointKind::constant_velocity:
      if (std::numbers::pi_v<Real> - angle_between(one.z, two.z) < kAligned)
        table.fail("markers", "the z axes of the two markers must not point against each other");
      return rotated_frame(one, one.z, two.z);
    case JointKind::spherical:
    case JointKind::distance:
    case JointKind::point_on_line:
    case JointKind::point_on_plane:
      break;
  }
  return two;
}

// Markers must satisfy the joint's constraints at t = 0 to kAligned; the second marker is then rotated to
// satisfy them exactly.
Ends spatial_ends(const DeckTable& table, const Model& model, const Connection& connection,
                  const Joint& joint) {
  Mat3 frame[2];
  if (!connection.markers) {
    place_frames(table, joint, frame);
    return find_ends(table, model, connection, frame);
  }
  Ends ends = *connection.markers;
  for (std::size_t side = 0; side < 2; ++side)
    frame[side] = global_frame(model, joint.body[side], ends[side].orientation);
  const Mat3 second = aligned(table, joint.kind, frame[0], frame[1]);
  ends[1].orientation = marker_at(model, joint.body[1], {}, second).orientation;
  return ends;
}

// Throws InputError for joints that planar bodies do not support.
void check_planar(const DeckTable& table, const Joint& joint) {
  switch (joint.kind) {
    case JointKind::revolute:
      if (table.has("axis")) table.fail("axis", "planar bodies turn about z; leave it out");
      return;
    case JointKind::translational:
    case JointKind::fixed:
    case JointKind::distance:
      return;
    default:
      table.fail("type",
                 fmt::format("\"{}\" is for spatial bodies (bodies.kind); planar ones take \"revolute\", "
                             "\"translational\", \"fixed\" and \"distance\"",
                             word_of(joint.kind)));
  }
}

std::string body_name(const Model& model, int body) {
  return body == kGround ? kGroundName : model.bodies[static_cast<std::size_t>(body)].name;
}

std::string shown_point(const Model& model, const Joint& joint, Vec3 p) {
  return between(model, joint.body) == BodyKind::spatial ? fmt::format("({}, {}, {})", p.x, p.y, p.z)
                                                         : fmt::format("({}, {})", p.x, p.y);
}

void check_joint_closed(const DeckTable& table, const Model& model, const Joint& joint) {
  const JointGap gap = joint_gap(model, joint);
  if (gap.meets()) return;
  const std::string key = joint.kind == JointKind::distance ? "distance"
                          : table.has("markers")            ? "markers"
                                                            : "local_points";
  table.fail(
      table.has(key) ? key : "name",
      fmt::format("the two sides of joint \"{}\" do not meet: at t = 0 the point of {} is at {}, that of "
                  "{} at {}, off by {:.6g} m",
                  joint.name, body_name(model, joint.body[0]), shown_point(model, joint, gap.end[0]),
                  body_name(model, joint.body[1]), shown_point(model, joint, gap.end[1]), gap.size));
}

bool has_common_point(JointKind kind) {
  return kind != JointKind::distance && kind != JointKind::parallel && kind != JointKind::perpendicular &&
         kind != JointKind::orientation;
}

// Markers may start rotated and displaced: the initial state defines the screw's offset.
void read_screw(const DeckTable& table, const Model& model, Joint& joint) {
  joint.lead = table.real("lead");
  if (joint.lead == 0) table.fail("lead", "must not be 0; use a revolute joint instead");
  Mat3 frame[2];
  for (int side = 0; side < 2; ++side)
    frame[side] = global_frame(model, joint.body[side], joint.marker[side]);
  const Vec3 apart = to_global_point(model, joint.body[1], joint.point[1]) -
                     to_global_point(model, joint.body[0], joint.point[0]);
  const Real angle = std::atan2(dot(frame[0].y, frame[1].x), dot(frame[0].x, frame[1].x));
  joint.advance = dot(apart, frame[0].z) - joint.lead / (2 * M_PI) * angle;
}

Joint build_joint(const DeckTable& table, const Model& model, const Connection& connection) {
  Joint joint;
  joint.name = connection.name, joint.deck_label = table.label();
  joint.kind = table.choice<JointKind>("type");
  for (int side = 0; side < 2; ++side) joint.body[side] = connection.body[side];
  check_same_kind(table, model, connection);
  check_without_markers(table, {"point", "points", "local_points", "axis", "second_axis"});
  const bool spatial = between(model, joint.body) == BodyKind::spatial;
  if (!spatial) check_planar(table, joint);
  if (joint.kind == JointKind::distance) {
    find_end_points(table, model, connection, joint.point);
    joint.distance =
        table.has("distance") ? table.real("distance") : start_distance(model, joint.body, joint.point);
    if (joint.distance == 0) table.fail("name", "the two points of a distance joint must not coincide");
  } else if (!spatial) {
    find_common_points(table, model, connection, joint.point);
  }
  if (spatial) {
    const Ends ends = spatial_ends(table, model, connection, joint);
    for (std::size_t side = 0; side < 2; ++side) {
      if (has_common_point(joint.kind)) joint.point[side] = ends[side].point;
      joint.marker[side] = ends[side].orientation;
    }
    if (joint.kind == JointKind::screw) read_screw(table, model, joint);
  } else {
    if (joint.kind == JointKind::translational)
      joint.axis = to_body_direction(model, joint.body[0], global_axis(table));
    joint.angle_offset = start_angle(model, joint.body[1]) - start_angle(model, joint.body[0]);
  }
  check_joint_closed(table, model, joint);
  return joint;
}

}  // namespace

void build_joints(const DeckTable& deck, Model& model, ModelNames& names) {
  for (const DeckTable& table : deck.tables("joints")) {
    for (const Connection& connection : find_connections(table, names)) {
      add_name(names.joints, connection.name, static_cast<int>(model.joints.size()), table);
      model.joints.push_back(build_joint(table, model, connection));
    }
  }
  NameMap taken = names.joints;  // the history has reactions of drivers and joints in one group of datasets
  for (const DeckTable& table : deck.tables("drivers")) {
    add_name(taken, table.text("name"), 0, table);
    const int joint = find_name(names.joints, table, "joint", "joint");
    const Joint& driven = model.joints[static_cast<std::size_t>(joint)];
    if (coordinates_of(driven.kind).empty())
      table.fail("joint", fmt::format("a {} joint cannot be driven; it must be revolute, translational, "
                                      "cylindrical, screw, universal or distance",
                                      word_of(driven.kind)));
    const JointCoordinate coordinate = read_coordinate(table, driven);
    model.drivers.push_back(
        {table.text("name"), joint, build_motion(table.table("motion")), coordinate, table.label()});
  }
}

}  // namespace scree
