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
          .about("The two markers between which it stands, in place of the bodies, of points and axes; with "
                 "chain "
                 "or each, of every element: markers of the row, with each the first one on the ground."),
      text("chain").left_out("none").about(
          "Name of a row of bodies: one element between each body and the next, named NAME.0, NAME.1, ..."),
      text("each").left_out("none").about(
          "Name of a row of bodies: one element between the ground and each body, named NAME.0, ...")};
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
      "points, which pushes them apart where it is above 0. It acts, as a motor does, on the distance of the "
      "two points, the length l; stops may keep l within the stroke.",
      {vectors("points", "m")
           .entries(2)
           .left_out("the two bodies' centres")
           .about("The two end points at t = 0 in the global frame."),
       local_points_key(),
       choice<Kind>("type").required().about(
           "Force: a function of time. Speed: gain e + integral_gain (integral of e over time), e = speed - "
           "l': a pump that gives a flow; the integral stands while the limit holds the force. Length: "
           "position_gain e + rate_gain e', e = length - l: a servo."),
       quantity("force", "N", time_function_keys())
           .required()
           .only_for({Kind::force})
           .about("Function of time; above 0 it extends the cylinder."),
       quantity("speed", "m/s", time_function_keys())
           .required()
           .only_for({Kind::speed})
           .about("Function of time: the rate of the length that is wanted; above 0 the cylinder extends."),
       quantity("length", "m", time_function_keys())
           .required()
           .only_for({Kind::length})
           .about("Function of time: the length that is wanted."),
       real("gain", "N s/m")
           .above(0)
           .required()
           .only_for({Kind::speed})
           .about("Force per speed that is missing."),
       real("integral_gain", "N/m")
           .at_least(0)
           .otherwise("0.0")
           .only_for({Kind::speed})
           .about("Force per integral of the speed that is missing, the stiffness of the oil; 0: a load "
                  "leaves a rest of speed."),
       real("position_gain", "N/m")
           .above(0)
           .required()
           .only_for({Kind::length})
           .about("Force per length that is missing: a load leaves load / position_gain of it."),
       real("rate_gain", "N s/m")
           .at_least(0)
           .otherwise("0.0")
           .only_for({Kind::length})
           .about("Force per rate of it."),
       real("limit", "N")
           .above(0)
           .left_out("none")
           .about("Largest force either way, as a relief valve sets it. Stops push beside it."),
       real("min_length", "m").above(0).left_out("none").about("Length of the retracted cylinder, a stop."),
       real("max_length", "m").above(0).left_out("none").about("Length of the extended cylinder, a stop."),
       real("stop_stiffness", "N/m")
           .above(0)
           .left_out("there are no stops")
           .about("Of the stops: beyond one, by d > 0, stop_stiffness d + stop_damping d' pushes back, and "
                  "never pulls."),
       real("stop_damping", "N s/m").at_least(0).left_out("0").about("Of the stops.")},
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
       real("free_length", "m").at_least(0).left_out("the length at t = 0").about("Length without tension."),
       quantity("actuator", "N", time_function_keys())
           .otherwise("0.0")
           .about("Function of time; positive pulls the two points together.")});
  return keys;
}

const TableKeys& torsional_spring_damper_keys() {
  static const TableKeys keys = with_connection(
      "Torsional springs with dampers: torque on the second body = -(k (theta - free_angle) + c theta').",
      {real("stiffness", "N m/rad").at_least(0).otherwise("0.0").about("k."),
       real("damping", "N m s/rad").at_least(0).otherwise("0.0").about("c."),
       real("free_angle", "rad")
           .left_out("the angle at t = 0")
           .about("theta without torque; theta: angle of the second body minus that of the first.")});
  return keys;
}

const TableKeys& bushing_keys() {
  static const TableKeys keys = with_connection(
      "Bushings between spatial bodies, or one and the ground: K x + C x' + preload pulls the second body's "
      "frame back onto the first one's. x: the displacement of the second point along the first frame's "
      "axes, then the rotation vector from the first frame to the second, for turns of up to 2.6 rad.",
      {vector("point", "m")
           .left_out("local_points or markers is given")
           .about("The bushing's point at t = 0 in the global frame."),
       local_points_key(),
       vector("axis", "")
           .left_out("the frame's axes are the global ones at t = 0")
           .about("z axis of the bushing's frame at t = 0 in the global frame, of any length but 0."),
       vector("second_axis", "")
           .left_out("axis is left out, too")
           .about("Its x axis, likewise, perpendicular to axis."),
       reals("stiffness", "N/m, N m/rad")
           .required()
           .about("K: its diagonal, six numbers, or all of it row by row, 36 numbers [N/m, N/rad; N m/m, N "
                  "m/rad]; symmetric, and no deflection may have an energy below 0."),
       reals("damping", "N s/m, N m s/rad").left_out("zero").about("C, likewise."),
       reals("preload", "N, N m")
           .entries(6)
           .left_out("zero")
           .about("What the bushing carries without deflection: above 0 it pulls the second body back along "
                  "the axis.")});
  return keys;
}

const TableKeys& applied_force_keys() {
  static const TableKeys keys{
      "Forces and torques on a body as functions of time.",
      {name_key().required().about("Name for messages."),
       text("body").left_out("marker is given").about("The body that they act on."),
       text("marker")
           .left_out("body is given")
           .about("The marker that they act at, in place of body and point; those that follow the body are "
                  "along its axes."),
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
           .about("Whether the force's direction turns with the body, with spatial bodies that of the torque "
                  "too.")},
      ""};
  return keys;
}

}  // namespace scree
