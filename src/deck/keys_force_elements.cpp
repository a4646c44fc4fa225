// Keys of force elements: between two points or bodies, or on one body.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

// Which two bodies a joint or a force element connects. Exactly one of the three is given.
std::vector<Key> connection_keys() {
  return {
      texts("bodies")
          .entries(2)
          .left_out("markers, chain or each is given")
          .about("The two bodies; one of them may be \"ground\"."),
      texts("markers")
          .entries(2)
          .left_out("points and axes are as other keys say")
          .about("The two markers that the element connects, in place of bodies, points and axes. With chain "
                 "or each they hold for every element: the markers are then those of a row of bodies; with "
                 "each, the first one is on the ground."),
      text("chain").left_out("none").about(
          "Name of a row of bodies: one element between each body and the next, named NAME.0, NAME.1, ..."),
      text("each").left_out("none").about("Name of a row of bodies: one element between the ground and each "
                                          "body, named NAME.0, NAME.1, ...")};
}

}  // namespace

TableKeys with_connection(const std::string& sentence, std::vector<Key> own, const std::string& selector) {
  std::vector<Key> keys{name_key().required().about("Name for references, messages and results.")};
  for (const Key& key : connection_keys()) keys.push_back(key);
  for (const Key& key : own) keys.push_back(key);
  return {sentence, keys, selector};
}

Key local_points_key() {
  return vectors("local_points", "m")
      .entries(2)
      .left_out("none")
      .about("The two points, each in its body's frame, in place of global ones.");
}

const TableKeys& cylinder_keys() {
  using Kind = CylinderKind;
  static const TableKeys keys = with_connection(
      "Hydraulic cylinders and other linear actuators, without mass: a force along the line between two "
      "points; a force above 0 pushes them apart. It acts, as a motor does, on a coordinate: the distance l "
      "of the two points. Stops may keep l within the stroke.",
      {vectors("points", "m")
           .entries(2)
           .left_out("the two bodies' centres")
           .about("The two end points at t = 0 in the global frame."),
       local_points_key(),
       choice<Kind>("type").required().about(
           "Force: a function of time. Speed: gain e + integral_gain (integral of e over time), e = speed - "
           "l': a pump with a given flow; the integral is held while the force is at the limit. Length: "
           "position_gain e + rate_gain e', e = length - l: a servo."),
       quantity("force", "N", time_function_keys())
           .required()
           .only_for({Kind::force})
           .about("Function of time; above 0 it extends the cylinder."),
       quantity("speed", "m/s", time_function_keys())
           .required()
           .only_for({Kind::speed})
           .about("Function of time: the demanded rate of the length; above 0 the cylinder extends."),
       quantity("length", "m", time_function_keys())
           .required()
           .only_for({Kind::length})
           .about("Function of time: the demanded length."),
       real("gain", "N s/m").above(0).required().only_for({Kind::speed}).about("Force per speed error."),
       real("integral_gain", "N/m")
           .at_least(0)
           .otherwise("0.0")
           .only_for({Kind::speed})
           .about("Force per time integral of the speed error: the stiffness of the oil. With 0, a load "
                  "leaves a constant speed error."),
       real("position_gain", "N/m")
           .above(0)
           .required()
           .only_for({Kind::length})
           .about("Force per length error; a load leaves an error of load / position_gain."),
       real("rate_gain", "N s/m")
           .at_least(0)
           .otherwise("0.0")
           .only_for({Kind::length})
           .about("Force per rate of the length error."),
       real("limit", "N")
           .above(0)
           .left_out("none")
           .about("Largest force in either direction, as set by a relief valve. The force of the stops is "
                  "not limited by it."),
       real("min_length", "m").above(0).left_out("none").about("Length of the retracted cylinder: a stop."),
       real("max_length", "m").above(0).left_out("none").about("Length of the extended cylinder: a stop."),
       real("stop_stiffness", "N/m")
           .above(0)
           .left_out("there are no stops")
           .about("Stiffness of the stops: at a distance d > 0 beyond a stop, the force stop_stiffness d + "
                  "stop_damping d' pushes back; it never pulls."),
       real("stop_damping", "N s/m").at_least(0).left_out("0").about("Damping of the stops.")},
      "type");
  return keys;
}

const TableKeys& spring_damper_keys() {
  static const TableKeys keys = with_connection(
      "Springs with dampers and actuators between two points: tension = k (l - free_length) + c l' + "
      "actuator.",
      {vectors("points", "m")
           .entries(2)
           .left_out("the two bodies' centres")
           .about("The two end points at t = 0 in the global frame."),
       local_points_key(), real("stiffness", "N/m").at_least(0).otherwise("0.0").about("k."),
       real("damping", "N s/m").at_least(0).otherwise("0.0").about("c."),
       real("free_length", "m")
           .at_least(0)
           .left_out("the length at t = 0")
           .about("Length at which the spring is unloaded."),
       quantity("actuator", "N", time_function_keys())
           .otherwise("0.0")
           .about("Function of time; above 0 it pulls the two points together.")});
  return keys;
}

const TableKeys& torsional_spring_damper_keys() {
  static const TableKeys keys = with_connection(
      "Torsional springs with dampers: torque on the second body = -(k (theta - free_angle) + c theta').",
      {real("stiffness", "N m/rad").at_least(0).otherwise("0.0").about("k."),
       real("damping", "N m s/rad").at_least(0).otherwise("0.0").about("c."),
       real("free_angle", "rad")
           .left_out("the angle at t = 0")
           .about("theta at which the spring is unloaded; theta: angle of the second body minus that of the "
                  "first.")});
  return keys;
}

const TableKeys& bushing_keys() {
  static const TableKeys keys = with_connection(
      "Bushings between spatial bodies, or between a spatial body and the ground: K x + C x' + preload acts "
      "on the second body towards the first body's frame. x: the displacement of the second point along the "
      "axes of the first frame, then the rotation vector from the first frame to the second, for rotations "
      "of up to 2.6 rad.",
      {vector("point", "m")
           .left_out("local_points or markers is given")
           .about("The bushing's point at t = 0 in the global frame."),
       local_points_key(),
       vector("axis", "")
           .left_out("the frame's axes are the global ones at t = 0")
           .about("z axis of the bushing's frame at t = 0 in the global frame, of any length but 0."),
       vector("second_axis", "")
           .left_out("axis is left out, too")
           .about("x axis of the bushing's frame at t = 0 in the global frame, perpendicular to axis."),
       reals("stiffness", "N/m, N m/rad")
           .required()
           .about("K: six numbers (its diagonal), or all 36 row by row [N/m, N/rad; N m/m, N m/rad]; "
                  "symmetric and positive semidefinite."),
       reals("damping", "N s/m, N m s/rad")
           .left_out("zero")
           .about("C: six numbers (its diagonal), or all 36 row by row."),
       reals("preload", "N, N m")
           .entries(6)
           .left_out("zero")
           .about("Load at zero deflection: above 0 it pulls the second body back along the axis.")});
  return keys;
}

const TableKeys& applied_force_keys() {
  static const TableKeys keys{
      "Forces and torques on a body as functions of time.",
      {name_key().required().about("Name for messages."),
       text("body").left_out("marker is given").about("The body on which they act."),
       text("marker")
           .left_out("body is given")
           .about("The marker at which they act, in place of body and point; forces that follow the body are "
                  "along the marker's axes."),
       vector("point", "m")
           .left_out("the body's centre")
           .about("Point of action at t = 0 in the global frame."),
       vector("local_point", "m")
           .left_out("none")
           .about("Point of action in the body's frame, in place of point."),
       quantity("fx", "N", time_function_keys()).otherwise("0.0").about("Force along x."),
       quantity("fy", "N", time_function_keys()).otherwise("0.0").about("Force along y."),
       quantity("fz", "N", time_function_keys()).otherwise("0.0").about("Force along z, on spatial bodies."),
       quantity("torque_x", "N m", time_function_keys())
           .otherwise("0.0")
           .about("Torque about x, on spatial bodies."),
       quantity("torque_y", "N m", time_function_keys())
           .otherwise("0.0")
           .about("Torque about y, on spatial bodies."),
       quantity("torque_z", "N m", time_function_keys()).otherwise("0.0").about("Torque about z."),
       boolean("follows_body")
           .otherwise("false")
           .about("Whether the direction of the force rotates with the body; on spatial bodies also that of "
                  "the torque.")},
      ""};
  return keys;
}

}  // namespace scree
