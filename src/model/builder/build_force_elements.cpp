// Spring-dampers, torsional spring-dampers and applied forces.
#include "model/builder/build_parts.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/time_functions.hpp"

namespace scree {

namespace {

void build_spring_dampers(const DeckTable& table, Model& model, const ModelNames& names, NameMap& taken) {
  for (const Connection& connection : find_connections(table, names)) {
    add_name(taken, connection.name, static_cast<int>(taken.size()), table);
    SpringDamper element;
    element.name = connection.name;
    for (int side = 0; side < 2; ++side) element.body[side] = connection.body[side];
    find_end_points(table, model, connection, element.point);
    check_same_kind(table, model, connection);
    const Real length = start_distance(model, element.body, element.point);
    if (length == 0) table.fail("name", "the two points of a spring-damper must not coincide at t = 0");
    element.stiffness = table.real("stiffness");
    element.damping = table.real("damping");
    element.free_length = table.has("free_length") ? table.real("free_length") : length;
    element.actuator = build_force(table.table("actuator"));
    model.spring_dampers.push_back(std::move(element));
  }
}

void build_torsional(const DeckTable& table, Model& model, const ModelNames& names, NameMap& taken) {
  for (const Connection& connection : find_connections(table, names)) {
    add_name(taken, connection.name, static_cast<int>(taken.size()), table);
    TorsionalSpringDamper element;
    element.name = connection.name;
    for (int side = 0; side < 2; ++side) element.body[side] = connection.body[side];
    if (between(model, element.body) == BodyKind::spatial)
      table.fail(
          "name",
          "torsional springs are between planar bodies, or one and the ground; these are spatial: give "
          "a spring on the angle of their joint, [[joint_springs]]");
    check_same_kind(table, model, connection);
    element.stiffness = table.real("stiffness");
    element.damping = table.real("damping");
    element.free_angle = table.has("free_angle")
                             ? table.real("free_angle")
                             : start_angle(model, element.body[1]) - start_angle(model, element.body[0]);
    model.torsional_spring_dampers.push_back(element);
  }
}

bool acts(const TimeFunction& f) { return f.kind != TimeFunctionKind::constant || f.value != 0; }

AppliedForce build_applied_force(const DeckTable& table, const Model& model, const ModelNames& names) {
  AppliedForce force;
  force.name = table.text("name");
  if (table.has("body") == table.has("marker"))
    table.fail("name", "exactly one of the keys body and marker must be given");
  if (table.has("marker")) {
    const NamedMarker& named = find_marker(names, table.text("marker"), table, "marker");
    force.body = named.bodies.front();
    if (named.row || force.body == kGround)
      table.fail("marker", "must be on a single body; this one is on " +
                               std::string(named.row ? "each body of a row" : "the ground"));
    for (const char* key : {"point", "local_point"})
      if (table.has(key)) table.fail(key, "not used together with marker");
    force.point = named.marker.point, force.axes = named.marker.orientation;
  } else {
    force.body = find_name(names.bodies, table, "body", "body");
  }
  if (table.has("point") && table.has("local_point"))
    table.fail("local_point", "not used together with point");
  if (table.has("point")) force.point = to_body_point(model, force.body, table.vector("point"));
  if (table.has("local_point")) force.point = from_center(model, force.body, table.vector("local_point"));
  force.fx = build_force(table.table("fx"));
  force.fy = build_force(table.table("fy"));
  force.torque = build_force(table.table("torque_z"));
  force.fz = build_force(table.table("fz"));
  force.torque_x = build_force(table.table("torque_x"));
  force.torque_y = build_force(table.table("torque_y"));
  if (model.bodies[static_cast<std::size_t>(force.body)].kind == BodyKind::planar)
    for (const char* key : {"fz", "torque_x", "torque_y"})
      if (acts(build_force(table.table(key))))
        table.fail(key, "must be 0: the body is planar; give it kind = \"spatial\"");
  force.follows_body = table.boolean("follows_body");
  return force;
}

}  // namespace

void build_force_elements(const DeckTable& deck, Model& model, const ModelNames& names) {
  NameMap springs, torsional;
  for (const DeckTable& table : deck.tables("spring_dampers"))
    build_spring_dampers(table, model, names, springs);
  for (const DeckTable& table : deck.tables("torsional_spring_dampers")) {
    build_torsional(table, model, names, torsional);
  }
  for (const DeckTable& table : deck.tables("applied_forces")) {
    model.applied_forces.push_back(build_applied_force(table, model, names));
  }
}

}  // namespace scree
