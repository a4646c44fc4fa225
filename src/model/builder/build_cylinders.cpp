// Cylinders: each becomes a joint with a free length, a motor on this length and, with a stroke, a stop.
#include <fmt/format.h>

#include "model/builder/build_parts.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/time_functions.hpp"

namespace scree {

namespace {

Joint build_line(const DeckTable& table, const Model& model, const Connection& connection) {
  Joint line;
  line.name = connection.name, line.deck_label = table.label();
  line.kind = JointKind::distance, line.telescopes = true;
  for (int side = 0; side < 2; ++side) line.body[side] = connection.body[side];
  check_same_kind(table, model, connection);
  find_end_points(table, model, connection, line.point);
  line.distance = start_distance(model, line.body, line.point);
  // The direction between two points that differ by round-off is undefined.
  constexpr Real kRoundOff = 1e-12;
  const Real size = norm(to_global_point(model, line.body[0], line.point[0]));
  if (line.distance <= kRoundOff * size)
    table.fail("name", "the two points of a cylinder must not coincide at t = 0");
  for (std::size_t side = 0; side < 2; ++side)
    line.marker[side] = connection.markers ? (*connection.markers)[side].orientation
                                           : marker_at(model, line.body[side], {}, identity3()).orientation;
  return line;
}

Motor build_drive(const DeckTable& table) {
  Motor motor;
  if (table.has("limit")) motor.limit = table.real("limit");
  switch (table.choice<CylinderKind>("type")) {
    case CylinderKind::force:
      motor.kind = MotorKind::effort;
      motor.effort = build_force(table.table("force"));
      break;
    case CylinderKind::speed:
      motor.kind = MotorKind::speed;
      motor.rate = build_force(table.table("speed"));
      motor.gain = table.real("gain"), motor.integral_gain = table.real("integral_gain");
      break;
    case CylinderKind::length:
      motor.kind = MotorKind::position;
      motor.position = build_motion(table.table("length"));
      motor.position_gain = table.real("position_gain"), motor.rate_gain = table.real("rate_gain");
      break;
  }
  return motor;
}

// length: at t = 0 [m].
JointLimit build_stops(const DeckTable& table, Real length) {
  JointLimit stops;
  if (table.has("min_length")) stops.lower = table.real("min_length");
  if (table.has("max_length")) stops.upper = table.real("max_length");
  if (!(stops.lower < stops.upper))
    table.fail("max_length", fmt::format("must be above min_length = {}", stops.lower));
  for (const char* key : {"min_length", "max_length"})
    if (table.has(key) && (length < stops.lower || length > stops.upper))
      table.fail(key, fmt::format("the two points are {:.6g} m apart at t = 0, outside the stroke", length));
  stops.stiffness = table.real("stop_stiffness");
  if (table.has("stop_damping")) stops.damping = table.real("stop_damping");
  return stops;
}

bool has_stops(const DeckTable& table) {
  const bool stops = table.has("min_length") || table.has("max_length");
  if (stops && !table.has("stop_stiffness"))
    table.fail("stop_stiffness", "missing; min_length and max_length are stops and need it");
  for (const char* key : {"stop_stiffness", "stop_damping"})
    if (!stops && table.has(key)) table.fail(key, "not used without min_length or max_length");
  return stops;
}

}  // namespace

void build_cylinders(const DeckTable& deck, Model& model, ModelNames& names) {
  for (const DeckTable& table : deck.tables("cylinders")) {
    const Motor drive = build_drive(table);
    const bool stops = has_stops(table);
    for (const Connection& connection : find_connections(table, names)) {
      const int number = static_cast<int>(model.joints.size());
      add_name(names.joints, connection.name, number, table);
      model.joints.push_back(build_line(table, model, connection));
      model.motors.push_back(drive);
      model.motors.back().name = connection.name, model.motors.back().joint = number;
      if (!stops) continue;
      model.joint_limits.push_back(build_stops(table, model.joints.back().distance));
      model.joint_limits.back().name = connection.name + ".stops", model.joint_limits.back().joint = number;
    }
  }
}

}  // namespace scree
