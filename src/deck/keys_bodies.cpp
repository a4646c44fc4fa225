// Keys of bodies, joints and drivers, and of functions of time.
#include <algorithm>

#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

Key surface_material() {
  return text("material").left_out("the only material; not needed where collides = false").about("Material.");
}

Key collides_key() {
  return boolean("collides")
      .otherwise("true")
      .about(
          "Whether it takes part in contact detection. false: it appears in pictures and results only; "
          "particles, bodies and walls pass through it.");
}

TableKeys make_body_keys() {
  static const TableKeys shapes{
      "Circles (2D) or spheres (3D) fixed to the body, for contact and for pictures.",
      {real("radius", "m").above(0).required().about("Radius."),
       vector("offset", "m")
           .otherwise("zero")
           .about("Centre in the body's frame; for a row or an array, that of the first shape."),
       integer("count")
           .within(1, 10000000)
           .left_out("a single shape")
           .about("Number of equal shapes in a row."),
       integers("size")
           .at_least(1)
           .left_out("no array")
           .about("In place of count: an array of equal shapes, with this number of shapes along each axis "
                  "of the body's frame."),
       vector("spacing", "m")
           .left_out("a single shape")
           .about("Row: vector from each shape to the next. Array: distance along each axis."),
       texts("sides")
           .left_out("all of the array")
           .about("The sides of the array that are kept; the other shapes are omitted: [\"x_min\", "
                  "\"x_max\", \"y_min\", \"y_max\"] are the outline of a rectangle, [\"x_min\", \"x_max\", "
                  "\"y_min\"] a tray."),
       surface_material(), collides_key()},
      ""};
  static const TableKeys meshes{
      "Meshes fixed to the body, for contact with particles and planes. They have no mass: see solids.",
      {text("mesh").required().about("Name of one of the meshes; its frame is that of the body."),
       surface_material(), collides_key()},
      ""};
  static constexpr auto planar = {BodyKind::planar}, spatial = {BodyKind::spatial};
  TableKeys keys{
      "Rigid bodies: one, or a row of equal ones.",
      {name_key().required().about("Name; the bodies of a row are called NAME.0, NAME.1, ..."),
       choice<BodyKind>("kind")
           .otherwise_choice(BodyKind::planar)
           .about("Planar: moves in the x-y plane or in a plane parallel to it, and rotates about z. "
                  "Spatial: needs space.dimension = 3, and moves and rotates in any direction."),
       integer("count").within(1, 10000000).left_out("a single body").about("Number of bodies in a row."),
       vector("spacing", "m").otherwise("zero").about("Vector from each body of a row to the next."),
       real("mass", "kg").above(0).left_out("solids are given").about("Mass."),
       real("inertia", "kg m^2")
           .only_for(planar)
           .above(0)
           .left_out("solids are given")
           .about("Moment of inertia about the z axis through the centre of mass."),
       reals("inertia_tensor", "kg m^2")
           .only_for(spatial)
           .entries(6)
           .left_out("solids are given")
           .about("Jxx, Jyy, Jzz, Jxy, Jxz, Jyz about the centre of mass, along the axes of the body's frame "
                  "or, with the inertia_ keys, along other axes. The last three are entries of the tensor: "
                  "Jxy = - sum of m x y."),
       vector("center_of_mass", "m")
           .left_out("solids are given, or the origin")
           .about("Centre of mass in the body's frame."),
       vector("position", "m")
           .required()
           .about("Origin of the body's frame at t = 0; for a row, that of the first body. The origin is the "
                  "centre of mass unless center_of_mass or solids are given."),
       real("angle", "rad").only_for(planar).otherwise("0.0").about("Angle of the body's frame at t = 0."),
       vector("velocity", "m/s").otherwise("zero").about("Velocity of the frame's origin at t = 0."),
       real("angular_velocity", "rad/s")
           .only_for(planar)
           .otherwise("0.0")
           .about("Angular velocity at t = 0."),
       vector("body_angular_velocity", "rad/s")
           .only_for(spatial)
           .left_out("global_angular_velocity is given, or zero")
           .about("Angular velocity at t = 0 along the axes of the body's frame."),
       vector("global_angular_velocity", "rad/s")
           .only_for(spatial)
           .left_out("body_angular_velocity is given, or zero")
           .about("Angular velocity at t = 0 along the global axes."),
       boolean("collides")
           .otherwise("true")
           .about("false: none of its shapes and meshes collides, whatever their own keys are."),
       tables("shapes", shapes), tables("meshes", meshes), tables("solids", solid_keys())},
      "kind"};
  const auto add = [&](const char* before, std::vector<Key> added) {
    for (Key& key : added) key.only_for(spatial);
    keys.keys.insert(std::ranges::find(keys.keys, before, &Key::name), added.begin(), added.end());
  };
  add("center_of_mass", orientation_keys("inertia_", "the axes of inertia_tensor", "the body's frame"));
  add("velocity", orientation_keys("", "the body's frame at t = 0", "the global frame"));
  return keys;
}

}  // namespace

const TableKeys& body_keys() {
  static const TableKeys keys = make_body_keys();
  return keys;
}

const TableKeys& joint_keys() {
  using Kind = JointKind;
  static constexpr auto pointed = {Kind::revolute,      Kind::translational,     Kind::fixed,
                                   Kind::spherical,     Kind::cylindrical,       Kind::screw,
                                   Kind::universal,     Kind::constant_velocity, Kind::planar,
                                   Kind::point_on_line, Kind::point_on_plane};
  static constexpr auto with_axis = {Kind::revolute, Kind::translational, Kind::cylindrical,
                                     Kind::screw,    Kind::universal,     Kind::constant_velocity,
                                     Kind::planar,   Kind::point_on_line, Kind::point_on_plane,
                                     Kind::parallel, Kind::perpendicular};
  static constexpr auto with_two = {Kind::universal, Kind::constant_velocity, Kind::perpendicular};
  static const TableKeys keys = with_connection(
      "Joints between two bodies, or a body and the ground.",
      {choice<JointKind>("type").required().about(
           "Revolute: the two points coincide. Translational: the second body's point stays on the first "
           "body's axis, no relative rotation. Fixed: no relative motion. Distance: the distance between the "
           "two points is constant. Between spatial bodies a revolute joint also keeps the axes parallel, "
           "and there are more types. Spherical: the two points coincide. Cylindrical: the second body's "
           "point stays on the first body's axis, the axes stay parallel. Screw: as cylindrical, and the "
           "displacement along the axis grows by lead in every revolution. Universal: the points coincide, "
           "an arm of the first body (axis) stays perpendicular to an arm of the second (second_axis). "
           "Constant-velocity: the points coincide, the bodies rotate at the same rate about axis and "
           "second_axis. Planar: the second body's point stays in the plane through the first body's point "
           "perpendicular to the axis, the normals stay parallel. Point-on-line, point-on-plane: the point "
           "stays on the axis or in the plane, rotation is free. Parallel, perpendicular: the axes stay so, "
           "the points are free. Orientation: no relative rotation. With markers, the axis is z, and the "
           "arms of a universal joint are x of the first marker and y of the second. Axes that the joint "
           "aligns must agree at t = 0 to 1e-6 rad; those of the second marker are then made exact."),
       vector("point", "m")
           .only_for(pointed)
           .left_out("the body's centre (with the ground), or midway between the two centres")
           .about("The joint's point at t = 0 in the global frame."),
       vectors("points", "m")
           .only_for({JointKind::distance})
           .entries(2)
           .left_out("the two bodies' centres")
           .about("The two end points at t = 0 in the global frame."),
       local_points_key(),
       vector("axis", "")
           .only_for(with_axis)
           .left_out("[1, 0] or [1, 0, 0] for translational joints of planar bodies; not needed for revolute "
                     "joints of planar bodies; required otherwise")
           .about("Direction of the axis at t = 0 in the global frame, of any length but 0. For spatial "
                  "bodies it is z of the joint's marker on either body; the marker's x is the direction "
                  "perpendicular to it that is nearest to a global axis (of several, the first of x, y, z)."),
       vector("second_axis", "")
           .only_for(with_two)
           .left_out("markers are given")
           .about("Direction of the second body's axis or arm at t = 0 in the global frame; perpendicular to "
                  "axis, except for constant-velocity joints."),
       real("lead", "m")
           .only_for({JointKind::screw})
           .required()
           .about("Displacement of the second body along the axis in one revolution: above 0 a right-handed "
                  "screw, below 0 a left-handed one."),
       real("distance", "m")
           .only_for({JointKind::distance})
           .above(0)
           .left_out("the distance at t = 0")
           .about("The distance between the two points.")},
      "type");
  return keys;
}

const TableKeys& driver_keys() {
  static const TableKeys keys{
      "Prescribed motion of a joint.",
      {name_key().required().about("Name for messages and results."),
       text("joint").required().about("The driven joint. It must have a coordinate."), coordinate_key(),
       quantity("motion", "rad or m", time_function_keys())
           .required()
           .about("The coordinate as a function of time: the angle of the second body minus that of the "
                  "first (in space about the axis, 0 where the joint was given by point and axis, counted "
                  "beyond full revolutions), the displacement along the axis, the length of a distance "
                  "joint, or an angle of a universal joint.")},
      ""};
  return keys;
}

const TableKeys& time_function_keys() {
  using Kind = TimeFunctionKind;
  static constexpr auto started = {Kind::constant, Kind::ramp, Kind::sine, Kind::step};
  static const TableKeys keys{
      "A function of time: a number, or a table such as { kind = \"ramp\", rate = 2.0 }.",
      {choice<Kind>("kind").required().about(
           "Constant: value. Ramp: value + rate t. A ramp with an end is constant up to start; between start "
           "and end its slope grows smoothly as rate s^2 (3 - 2 s), s = (t - start) / (end - start); from "
           "end on it is value + rate (t - (start + end) / 2); it is of class C2. Sine: value + amplitude "
           "sin(2 pi frequency t + phase). Step: value up to start, end_value from end on, and between them "
           "value + (end_value - value) (10 s^3 - 15 s^4 + 6 s^5), of class C2. Table: a curve through the "
           "points."),
       real("value", kQuantityUnit)
           .only_for(started)
           .otherwise("0.0")
           .about("Constant part; for a step, the value before it."),
       real("end_value", kQuantityUnit).only_for({Kind::step}).required().about("Value after the step."),
       real("start", "s")
           .only_for({Kind::ramp, Kind::step})
           .required_for({Kind::step})
           .left_out("0 where a ramp has an end")
           .about("Time at which a step, or a ramp with an end, begins."),
       real("end", "s")
           .only_for({Kind::ramp, Kind::step})
           .required_for({Kind::step})
           .left_out("a ramp has its full slope at all times")
           .about("Time after start at which a step is complete, or a ramp has its full slope."),
       real("rate", kQuantityUnit + "/s").only_for({Kind::ramp}).required().about("Slope."),
       real("amplitude", kQuantityUnit).only_for({Kind::sine}).required().about("Amplitude."),
       real("frequency", "Hz").only_for({Kind::sine}).above(0).required().about("Frequency."),
       real("phase", "rad").only_for({Kind::sine}).otherwise("0.0").about("Phase."),
       reals("times", "s").only_for({Kind::table}).required().about("Times, increasing, at least two."),
       reals("values", kQuantityUnit).only_for({Kind::table}).required().about("Value at each time."),
       choice<Interpolation>("interpolation")
           .only_for({Kind::table})
           .left_out("\"natural\" for motions of drivers, walls and servos, \"linear\" otherwise")
           .about("Natural: cubic spline of class C2 whose second derivative is 0 at both ends; it "
                  "overshoots where the slope jumps, so it does not hold a constant position exactly. "
                  "Clamped: cubic spline of class C2 with end_rates at both ends; it overshoots as well. "
                  "Monotone: quintic pieces of class C2; between two points the curve stays within the range "
                  "of their values and depends on no points but these and their neighbours: for motions that "
                  "hold and then move. Linear: straight lines; for forces and torques only, because the "
                  "velocity of a motion would jump."),
       reals("end_rates", kQuantityUnit + "/s")
           .only_for({Kind::table})
           .entries(2)
           .left_out("0 at both ends")
           .about("Rates at the first and the last time, with interpolation = \"clamped\".")},
      "kind"};
  return keys;
}

}  // namespace scree
