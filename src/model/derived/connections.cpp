#include "model/derived/connections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "model/derived/frames.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

// Default point of a connection: the body's centre where the other side is the ground, otherwise midway
// between the centres [m].
Vec3 default_point(const Model& model, const Connection& connection) {
  const Vec3 a = start_position(model, connection.body[0]), b = start_position(model, connection.body[1]);
  if (connection.body[0] == kGround) return b;
  if (connection.body[1] == kGround) return a;
  return Real(0.5) * (a + b);
}

const Quaternion& start_orientation(const Model& model, int body) {
  return model.bodies[static_cast<std::size_t>(body)].orientation;
}

Connection named_pair(const DeckTable& table, const ModelNames& names) {
  Connection connection{table.text("name"), {}, {}};
  const std::vector<std::string>& bodies = table.texts("bodies");
  for (std::size_t side = 0; side < 2; ++side) {
    const auto row = names.rows.find(bodies[side]);
    if (row != names.rows.end() && !names.bodies.contains(bodies[side])) {
      table.fail("bodies", fmt::format("\"{0}\" is a row; name one of its bodies, \"{0}.0\" to \"{0}.{1}\"",
                                       bodies[side], row->second.size() - 1));
    }
    connection.body[side] = find_body(names, bodies[side], table, "bodies");
  }
  if (connection.body[0] == connection.body[1]) table.fail("bodies", "must be two different bodies");
  return connection;
}

using NamedEnds = std::array<const NamedMarker*, 2>;

NamedEnds named_ends(const DeckTable& table, const ModelNames& names) {
  NamedEnds ends{};
  for (std::size_t side = 0; side < 2; ++side) {
    const std::string& name = table.texts("markers")[side];
    ends[side] = &find_marker(names, name, table, "markers");
  }
  return ends;
}

Ends markers_of(const NamedEnds& ends) { return {ends[0]->marker, ends[1]->marker}; }

Connection marked_pair(const DeckTable& table, const NamedEnds& ends) {
  Connection connection{table.text("name"), {}, markers_of(ends)};
  for (std::size_t side = 0; side < 2; ++side) {
    if (ends[side]->row)
      table.fail("markers", fmt::format("\"{}\" is on each body of a row; chain or each must name that",
                                        table.texts("markers")[side]));
    connection.body[side] = ends[side]->bodies.front();
  }
  if (connection.body[0] == connection.body[1]) table.fail("markers", "must be on two different bodies");
  return connection;
}

// Marks the elements of a row, whose bodies have consecutive indices.
void mark_row(const DeckTable& table, const NamedEnds& ends, std::vector<Connection>& connections) {
  for (Connection& connection : connections) {
    for (std::size_t side = 0; side < 2; ++side)
      if (const std::vector<int>& on = ends[side]->bodies;
          connection.body[side] < on.front() || connection.body[side] > on.back())
        table.fail("markers", fmt::format("\"{}\" must be on {} here", table.texts("markers")[side],
                                          connection.body[side] == kGround ? "the ground" : "the row"));
    connection.markers = markers_of(ends);
  }
}

}  // namespace

std::vector<Connection> find_connections(const DeckTable& table, const ModelNames& names) {
  const bool marked = table.has("markers");
  const int rows = table.has("chain") + table.has("each");
  if (table.has("bodies") + rows + (marked && rows == 0) != 1)
    table.fail("name",
               "exactly one of the keys bodies, markers, chain and each must be given, or markers with "
               "chain or each");
  if (table.has("bodies")) return {named_pair(table, names)};
  if (rows == 0) return {marked_pair(table, named_ends(table, names))};
  const bool chain = table.has("chain");
  const std::string key = chain ? "chain" : "each";
  const std::vector<int>& row = find_row(names, table.text(key), table, key);
  if (chain && row.size() < 2) table.fail(key, "must name a row of two bodies or more");
  std::vector<Connection> connections;
  for (std::size_t i = chain ? 1 : 0; i < row.size(); ++i) {
    const std::string name = fmt::format("{}.{}", table.text("name"), connections.size());
    connections.push_back({name, {chain ? row[i - 1] : kGround, row[i]}, {}});
  }
  if (marked) mark_row(table, named_ends(table, names), connections);
  return connections;
}

BodyKind between(const Model& model, const int (&body)[2]) {
  const int one = body[1] == kGround ? body[0] : body[1];
  return one == kGround ? BodyKind::planar : model.bodies[static_cast<std::size_t>(one)].kind;
}

std::string with_label(const std::string& deck_label, const std::string& text) {
  return deck_label.empty() ? text : deck_label + ": " + text;
}

Vec3 start_position(const Model& model, int body) {
  return body == kGround ? Vec3{} : model.bodies[static_cast<std::size_t>(body)].position;
}

Real start_angle(const Model& model, int body) {
  return body == kGround ? 0 : model.bodies[static_cast<std::size_t>(body)].angle;
}

Vec3 to_body_point(const Model& model, int body, Vec3 global) {
  return to_body_direction(model, body, global - start_position(model, body));
}

Vec3 to_global_point(const Model& model, int body, Vec3 local) {
  return start_position(model, body) + to_global_direction(model, body, local);
}

Vec3 to_body_direction(const Model& model, int body, Vec3 global) {
  if (is_spatial(model, body))
    return transposed_times(rotation_matrix(start_orientation(model, body)), global);
  return Rotation(-start_angle(model, body)).turn(global);
}

Vec3 to_global_direction(const Model& model, int body, Vec3 local) {
  if (is_spatial(model, body)) return rotation_matrix(start_orientation(model, body)) * local;
  return Rotation(start_angle(model, body)).turn(local);
}

Vec3 from_center(const Model& model, int body, Vec3 local) {
  return body == kGround ? local : local - model.bodies[static_cast<std::size_t>(body)].center_of_mass;
}

Mat3 global_frame(const Model& model, int body, const Quaternion& orientation) {
  const Mat3 own = transposed(rotation_matrix(orientation));
  const auto turn = [&](Vec3 axis) { return to_global_direction(model, body, axis); };
  return {turn(own.x), turn(own.y), turn(own.z)};
}

Marker marker_at(const Model& model, int body, Vec3 point, const Mat3& frame) {
  const auto own = [&](Vec3 axis) { return to_body_direction(model, body, axis); };
  return {to_body_point(model, body, point),
          quaternion_of(transposed({own(frame.x), own(frame.y), own(frame.z)}))};
}

Ends find_ends(const DeckTable& table, const Model& model, const Connection& connection,
               const Mat3 (&frame)[2]) {
  if (connection.markers) return *connection.markers;
  Vec3 local[2];
  find_common_points(table, model, connection, local);
  Ends ends;
  for (std::size_t side = 0; side < 2; ++side)
    ends[side] = {local[side], marker_at(model, connection.body[side], {}, frame[side]).orientation};
  return ends;
}

void find_common_points(const DeckTable& table, const Model& model, const Connection& connection,
                        Vec3 local[2]) {
  if (table.has("local_points") && table.has("point"))
    table.fail("local_points", "not used together with point");
  if (table.has("point")) check_single(table, "point");
  const Vec3 point = table.has("point") ? table.vector("point") : default_point(model, connection);
  for (std::size_t side = 0; side < 2; ++side) {
    const int body = connection.body[side];
    local[side] = table.has("local_points") ? from_center(model, body, table.vectors("local_points")[side])
                                            : to_body_point(model, body, point);
  }
}

void check_without_markers(const DeckTable& table, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (table.has("markers") && table.has(key)) table.fail(key, "not used together with markers");
}

void find_end_points(const DeckTable& table, const Model& model, const Connection& connection,
                     Vec3 local[2]) {
  check_without_markers(table, {"points", "local_points"});
  if (table.has("points")) check_single(table, "points");
  if (table.has("points") && table.has("local_points"))
    table.fail("local_points", "not used together with points");
  for (std::size_t side = 0; side < 2; ++side) {
    const int body = connection.body[side];
    if (connection.markers) {
      local[side] = (*connection.markers)[side].point;
    } else if (table.has("local_points")) {
      local[side] = from_center(model, body, table.vectors("local_points")[side]);
    } else if (table.has("points")) {
      local[side] = to_body_point(model, body, table.vectors("points")[side]);
    } else if (body == kGround) {
      table.fail("points", "missing; the ground has no centre: give points or local_points, two points");
    } else {
      local[side] = {};
    }
  }
}

void check_same_kind(const DeckTable& table, const Model& model, const Connection& connection) {
  if (connection.body[0] == kGround || connection.body[1] == kGround) return;
  const auto spatial = [&](int side) { return is_spatial(model, connection.body[side]); };
  if (spatial(0) == spatial(1)) return;
  table.fail(table.has("bodies") ? "bodies" : "name",
             "connects a planar and a spatial body; both must be of one kind (bodies.kind)");
}

void check_single(const DeckTable& table, const std::string& key) {
  if (!table.has("bodies")) table.fail(key, "not used with chain or each; give local_points");
}

namespace {

// Violation of the joint's position constraints between spatial bodies [m].
Real spatial_gap(const Model& model, const Joint& joint, Vec3 apart) {
  const Vec3 axis =
      to_global_direction(model, joint.body[0], rotation_matrix(joint.marker[0]) * Vec3{0, 0, 1});
  const Real along = dot(apart, axis);
  switch (joint.kind) {
    case JointKind::translational:
    case JointKind::cylindrical:
    case JointKind::screw:
    case JointKind::point_on_line:
      return norm(apart - along * axis);
    case JointKind::planar:
    case JointKind::point_on_plane:
      return std::abs(along);
    case JointKind::parallel:
    case JointKind::perpendicular:
    case JointKind::orientation:
      return 0;
    case JointKind::distance:
      return std::abs(norm(apart) - joint.distance);
    default:
      return norm(apart);
  }
}

}  // namespace

JointGap joint_gap(const Model& model, const Joint& joint) {
  const Vec3 a = to_global_point(model, joint.body[0], joint.point[0]),
             b = to_global_point(model, joint.body[1], joint.point[1]);
  Vec3 apart = b - a;
  const Real allowed = 1e-9 * (1 + norm(a) + norm(b));
  if (between(model, joint.body) == BodyKind::spatial)
    return {{a, b}, spatial_gap(model, joint, apart), allowed};
  if (joint.kind == JointKind::translational) {
    const Vec3 axis = to_global_direction(model, joint.body[0], joint.axis);
    apart = apart - dot(apart, axis) * axis;
  }
  const Real length = std::hypot(apart.x, apart.y);
  return {{a, b}, joint.kind == JointKind::distance ? std::abs(length - joint.distance) : length, allowed};
}

bool points_coincide(const Joint& joint) {
  switch (joint.kind) {
    case JointKind::revolute:
    case JointKind::fixed:
    case JointKind::spherical:
    case JointKind::universal:
    case JointKind::constant_velocity:
      return true;
    default:
      return false;
  }
}

Real start_distance(const Model& model, const int (&body)[2], const Vec3 (&point)[2]) {
  const Vec3 apart = to_global_point(model, body[1], point[1]) - to_global_point(model, body[0], point[0]);
  return between(model, body) == BodyKind::spatial ? norm(apart) : std::hypot(apart.x, apart.y);
}

std::vector<bool> rowless_joints(const Model& model) {
  std::vector<bool> rowless;
  for (const Joint& joint : model.joints) rowless.push_back(joint.telescopes);
  for (const Driver& driver : model.drivers) {
    const auto joint = static_cast<std::size_t>(driver.joint);
    rowless[joint] = rowless[joint] || model.joints[joint].kind == JointKind::distance;
  }
  return rowless;
}

bool is_spatial(const Model& model, int body) {
  return body != kGround && model.bodies[static_cast<std::size_t>(body)].kind == BodyKind::spatial;
}

bool has_spatial_bodies(const Model& model) {
  return std::ranges::any_of(model.bodies, [](const Body& b) { return b.kind == BodyKind::spatial; });
}

int constraint_count(const Model& model) {
  const std::vector<bool> rowless = rowless_joints(model);
  int count = static_cast<int>(model.drivers.size() + model.couplers.size());
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = model.joints[j];
    const bool spatial = between(model, joint.body) == BodyKind::spatial;
    switch (joint.kind) {
      case JointKind::fixed:
        count += spatial ? 6 : 3;
        break;
      case JointKind::revolute:
      case JointKind::translational:
        count += spatial ? 5 : 2;
        break;
      case JointKind::screw:
        count += 5;
        break;
      case JointKind::cylindrical:
      case JointKind::universal:
      case JointKind::constant_velocity:
        count += 4;
        break;
      case JointKind::spherical:
        count += spatial ? 3 : 2;
        break;
      case JointKind::planar:
      case JointKind::orientation:
        count += 3;
        break;
      case JointKind::point_on_line:
      case JointKind::parallel:
        count += 2;
        break;
      case JointKind::point_on_plane:
      case JointKind::perpendicular:
        count += 1;
        break;
      case JointKind::distance:
        count += rowless[j] ? 0 : 1;
        break;
    }
  }
  return count;
}

int memory_count(const Model& model) {
  return static_cast<int>(std::ranges::count(model.motors, MotorKind::speed, &Motor::kind) +
                          std::ssize(model.joint_frictions));
}

}  // namespace scree
