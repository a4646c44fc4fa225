// Joints and drivers.
#include <fmt/format.h>

#include <cmath>

#include "model/build_parts.hpp"
#include "model/connections.hpp"
#include "model/joint_coordinates.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

// The body's centre where the other side is the ground, otherwise midway between the centres [m].
Vec3 default_point(const Model& model, const Connection& connection) {
  const Vec3 a = start_position(model, connection.body[0]), b = start_position(model, connection.body[1]);
  if (connection.body[0] == kGround) return b;
  if (connection.body[1] == kGround) return a;
  return Real(0.5) * (a + b);
}

// Local points of revolute, translational and fixed joints.
void place_common_point(const DeckTable& table, const Model& model, const Connection& connection,
                        Joint& joint) {
  if (table.has("local_points")) {
    if (table.has("point")) table.fail("local_points", "not used together with point");
    for (std::size_t side = 0; side < 2; ++side) joint.point[side] = table.vectors("local_points")[side];
    return;
  }
  if (table.has("point")) check_single(table, "point");
  const Vec3 point = table.has("point") ? table.vector("point") : default_point(model, connection);
  for (int side = 0; side < 2; ++side) joint.point[side] = to_body_point(model, joint.body[side], point);
}

Vec3 global_axis(const DeckTable& table) {
  const Vec3 axis = table.has("axis") ? table.vector("axis") : Vec3{1, 0, 0};
  if (std::hypot(axis.x, axis.y) == 0 || axis.z != 0)
    table.fail("axis", "must not be 0 and must lie in the x-y plane");
  return (1 / norm(axis)) * axis;
}

Vec3 direction(const DeckTable& table, const char* key) {
  if (!table.has(key)) table.fail(key, "missing; between spatial bodies this type of joint needs it");
  const Vec3 along = table.vector(key);
  if (norm(along) == 0) table.fail(key, "must not be 0");
  return (1 / norm(along)) * along;
}

// Rows x, y, z = axis of a right-handed frame, x the global axis that is most nearly across.
Mat3 frame_about(Vec3 axis) {
  const Real a = std::abs(axis.x), b = std::abs(axis.y), c = std::abs(axis.z);
  const Vec3 across = a <= b && a <= c ? Vec3{1, 0, 0} : b <= c ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 y = cross(axis, across), unit = (1 / norm(y)) * y;
  return {cross(unit, axis), unit, axis};
}

constexpr Real kSquare = 1e-9;  // cosine of axes that must be perpendicular

void check_square(const DeckTable& table, Vec3 axis, Vec3 second) {
  if (std::abs(dot(axis, second)) > kSquare)
    table.fail("second_axis", fmt::format("must be perpendicular to axis; the cosine between them is {:.3g}, "
                                          "allowed is {:g}",
                                          dot(axis, second), kSquare));
}

// The frames of the joint on either body at t = 0, rows x, y, z; see Joint::marker.
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
      const Vec3 normal = cross(one, two);
      const Real sine = norm(normal), cosine = dot(one, two);
      if (cosine < 0 && sine < kSquare) table.fail("second_axis", "must not point against axis");
      // The first frame turned onto the second axis by the shortest way.
      const Vec3 turn = sine > 0 ? (std::atan2(sine, cosine) / sine) * normal : Vec3{};
      const Mat3 bend = rotation_matrix(exponential(turn));
      frame[0] = frame_about(one);
      frame[1] = frame[0] * transposed(bend);
      return;
    }
    default:
      frame[0] = frame[1] = frame_about(direction(table, "axis"));
  }
}

void place_markers(const DeckTable& table, const Model& model, Joint& joint) {
  Mat3 frame[2];
  place_frames(table, joint, frame);
  for (int side = 0; side < 2; ++side) {
    const auto own = [&](Vec3 axis) { return to_body_direction(model, joint.body[side], axis); };
    joint.marker[side] =
        quaternion_of(transposed({own(frame[side].x), own(frame[side].y), own(frame[side].z)}));
  }
}

// What planar bodies cannot have.
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
  return body == kGround ? "ground" : model.bodies[static_cast<std::size_t>(body)].name;
}

std::string shown_point(const Model& model, const Joint& joint, Vec3 p) {
  return between(model, joint.body) == BodyKind::spatial ? fmt::format("({}, {}, {})", p.x, p.y, p.z)
                                                         : fmt::format("({}, {})", p.x, p.y);
}

void check_joint_meets(const DeckTable& table, const Model& model, const Joint& joint) {
  const JointGap gap = joint_gap(model, joint);
  if (gap.meets()) return;
  const std::string key = joint.kind == JointKind::distance ? "distance" : "local_points";
  table.fail(
      table.has(key) ? key : "name",
      fmt::format("the two sides of joint \"{}\" do not meet: at t = 0 the point of {} is at {}, that of "
                  "{} at {}, off by {:.6g} m",
                  joint.name, body_name(model, joint.body[0]), shown_point(model, joint, gap.end[0]),
                  body_name(model, joint.body[1]), shown_point(model, joint, gap.end[1]), gap.size));
}

bool has_points(JointKind kind) {
  return kind != JointKind::parallel && kind != JointKind::perpendicular && kind != JointKind::orientation;
}

// Markers may begin turned and apart: the start is on the screw.
void read_screw(const DeckTable& table, const Model& model, Joint& joint) {
  joint.lead = table.real("lead");
  if (joint.lead == 0) table.fail("lead", "must not be 0; a revolute joint has no advance");
  Mat3 frame[2];  // rows: the global axes of either frame
  for (int side = 0; side < 2; ++side) {
    const Mat3 own = rotation_matrix(joint.marker[side]);
    const auto axis = [&](Vec3 e) { return to_global_direction(model, joint.body[side], own * e); };
    frame[side] = {axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1})};
  }
  const Vec3 apart = to_global_point(model, joint.body[1], joint.point[1]) -
                     to_global_point(model, joint.body[0], joint.point[0]);
  const Real angle = std::atan2(dot(frame[0].y, frame[1].x), dot(frame[0].x, frame[1].x));
  joint.advance = dot(apart, frame[0].z) - joint.lead / (2 * M_PI) * angle;
}

Joint build_joint(const DeckTable& table, const Model& model, const Connection& connection) {
  Joint joint;
  joint.name = connection.name;
  joint.kind = table.choice<JointKind>("type");
  for (int side = 0; side < 2; ++side) joint.body[side] = connection.body[side];
  check_same_kind(table, model, connection);
  const bool spatial = between(model, joint.body) == BodyKind::spatial;
  if (!spatial) check_planar(table, joint);
  if (joint.kind == JointKind::distance) {
    find_end_points(table, model, connection, joint.point);
    const Vec3 ends = to_global_point(model, joint.body[1], joint.point[1]) -
                      to_global_point(model, joint.body[0], joint.point[0]);
    joint.distance = table.has("distance") ? table.real("distance")
                     : spatial             ? norm(ends)
                                           : std::hypot(ends.x, ends.y);
    if (joint.distance == 0) table.fail("name", "the two points of a distance joint must not coincide");
  } else if (has_points(joint.kind)) {
    place_common_point(table, model, connection, joint);
  }
  if (spatial) {
    place_markers(table, model, joint);
    if (joint.kind == JointKind::screw) read_screw(table, model, joint);
  } else {
    if (joint.kind == JointKind::translational)
      joint.axis = to_body_direction(model, joint.body[0], global_axis(table));
    joint.angle_offset = start_angle(model, joint.body[1]) - start_angle(model, joint.body[0]);
  }
  check_joint_meets(table, model, joint);
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
  NameMap taken = names.joints;  // the reactions of drivers and joints stand side by side in the history
  for (const DeckTable& table : deck.tables("drivers")) {
    add_name(taken, table.text("name"), 0, table);
    const int joint = find_name(names.joints, table, "joint", "joint");
    const Joint& driven = model.joints[static_cast<std::size_t>(joint)];
    if (coordinates_of(driven.kind).empty())
      table.fail("joint", fmt::format("a {} joint cannot be driven; it must be revolute, translational, "
                                      "cylindrical, screw or distance",
                                      word_of(driven.kind)));
    const JointCoordinate coordinate = read_coordinate(table, driven);
    model.drivers.push_back({table.text("name"), joint, build_motion(table.table("motion")), coordinate});
  }
}

}  // namespace scree
