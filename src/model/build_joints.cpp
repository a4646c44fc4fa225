// Joints and drivers.
#include <fmt/format.h>

#include <cmath>

#include "model/build_parts.hpp"
#include "model/connections.hpp"

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

std::string body_name(const Model& model, int body) {
  return body == kGround ? "ground" : model.bodies[static_cast<std::size_t>(body)].name;
}

void check_joint_meets(const DeckTable& table, const Model& model, const Joint& joint) {
  const JointGap gap = joint_gap(model, joint);
  if (gap.meets()) return;
  const std::string key = joint.kind == JointKind::distance ? "distance" : "local_points";
  table.fail(
      table.has(key) ? key : "name",
      fmt::format(
          "the two sides of joint \"{}\" do not meet: at t = 0 the point of {} is at ({}, {}), that of "
          "{} at ({}, {}), off by {:.6g} m",
          joint.name, body_name(model, joint.body[0]), gap.end[0].x, gap.end[0].y,
          body_name(model, joint.body[1]), gap.end[1].x, gap.end[1].y, gap.size));
}

Joint build_joint(const DeckTable& table, const Model& model, const Connection& connection) {
  Joint joint;
  joint.name = connection.name;
  joint.kind = table.choice<JointKind>("type");
  for (int side = 0; side < 2; ++side) joint.body[side] = connection.body[side];
  if (joint.kind == JointKind::distance) {
    find_end_points(table, model, connection, joint.point);
    const Vec3 ends = to_global_point(model, joint.body[1], joint.point[1]) -
                      to_global_point(model, joint.body[0], joint.point[0]);
    joint.distance = table.has("distance") ? table.real("distance") : std::hypot(ends.x, ends.y);
    if (joint.distance == 0) table.fail("name", "the two points of a distance joint must not coincide");
  } else {
    place_common_point(table, model, connection, joint);
  }
  if (joint.kind == JointKind::translational) {
    joint.axis = to_body_direction(model, joint.body[0], global_axis(table));
  }
  joint.angle_offset = start_angle(model, joint.body[1]) - start_angle(model, joint.body[0]);
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
    if (model.joints[static_cast<std::size_t>(joint)].kind == JointKind::fixed) {
      table.fail("joint", "a fixed joint cannot be driven; it must be revolute, translational or distance");
    }
    model.drivers.push_back({table.text("name"), joint, build_motion(table.table("motion"))});
  }
}

}  // namespace scree
