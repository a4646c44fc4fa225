// Keys of motors, springs, limits and friction on joints, and of couplers.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

Key joint_key() {
  return text("joint").required().about(
      "The joint (revolute, translational, cylindrical, screw or universal), or a row of joints: one for "
      "each, named "
      "NAME.0, NAME.1, ...; or a cylinder, whose coordinate is its length. Its coordinate c: the angle of "
      "its second body minus that of the first [rad], in "
      "space about the axis and counted on over whole turns, or the displacement along its axis [m]. An "
      "effort above 0 pushes c up.");
}

}  // namespace

const TableKeys& motor_keys() {
  static const TableKeys keys{
      "Motors: efforts on the coordinates of joints, a torque on an angle and a force on a displacement.",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       choice<MotorKind>("type").required().about("Effort: a function of time. Line: stall_effort (command - "
                                                  "c'/free_rate), the torque-speed line of a motor. "
                                                  "Speed: gain e + integral_gain (integral of e over time), "
                                                  "e = rate - c'; the integral stands while the limit "
                                                  "holds the motor back. Position: position_gain e + "
                                                  "rate_gain e', e = position - c: a servo."),
       real("limit", "N m or N").above(0).left_out("none").about("Largest effort, either way."),
       quantity("effort", "N m or N", time_function_keys())
           .required()
           .only_for({MotorKind::effort})
           .about("Function of time."),
       real("stall_effort", "N m or N")
           .above(0)
           .required()
           .only_for({MotorKind::line})
           .about("Effort at rest, with command 1."),
       real("free_rate", "rad/s or m/s")
           .above(0)
           .required()
           .only_for({MotorKind::line})
           .about("Rate without load, with command 1."),
       quantity("command", "", time_function_keys())
           .only_for({MotorKind::line})
           .otherwise("1.0")
           .about("Function of time: voltage or throttle as a part of the full one; below 0 it drives back."),
       quantity("rate", "rad/s or m/s", time_function_keys())
           .required()
           .only_for({MotorKind::speed})
           .about("Function of time: the rate that is wanted."),
       real("gain", "N m s/rad or N s/m")
           .above(0)
           .required()
           .only_for({MotorKind::speed})
           .about("Effort per rate that is missing."),
       real("integral_gain", "N m/rad or N/m")
           .only_for({MotorKind::speed})
           .at_least(0)
           .otherwise("0.0")
           .about("Effort per integral of the rate that is missing; 0: a load leaves a rest of it."),
       quantity("position", "rad or m", time_function_keys())
           .required()
           .only_for({MotorKind::position})
           .about("Function of time: the coordinate that is wanted."),
       real("position_gain", "N m/rad or N/m")
           .above(0)
           .required()
           .only_for({MotorKind::position})
           .about("Effort per distance from the wanted position; a load leaves load / position_gain of it."),
       real("rate_gain", "N m s/rad or N s/m")
           .only_for({MotorKind::position})
           .at_least(0)
           .otherwise("0.0")
           .about("Effort per rate of this distance: damps the servo.")},
      "type"};
  return keys;
}

const TableKeys& joint_spring_keys() {
  static const TableKeys keys{
      "Springs and dampers on the coordinates of joints: effort = -(k (c - free) + d c' + F(c) + G(c')).",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       real("stiffness", "N m/rad or N/m").at_least(0).otherwise("0.0").about("k."),
       real("damping", "N m s/rad or N s/m").at_least(0).otherwise("0.0").about("d."),
       real("free", "rad or m").left_out("c at t = 0").about("c at which k has no effort."),
       reals("coordinates", "rad or m").left_out("no F").about("Of a table F: c of its points, increasing."),
       reals("elastic_efforts", "N m or N")
           .left_out("no F")
           .about("F at the points: what it takes to hold the joint there. Past them F goes on in a straight "
                  "line."),
       reals("rates", "rad/s or m/s").left_out("no G").about("Of a table G: c' of its points, increasing."),
       reals("damping_efforts", "N m or N")
           .left_out("no G")
           .about("G at the points: what it takes to keep the joint moving."),
       choice<Interpolation>("interpolation")
           .otherwise_choice(Interpolation::linear)
           .about("Of both tables, as of functions of time; not clamped.")},
      ""};
  return keys;
}

const TableKeys& joint_limit_keys() {
  static const TableKeys keys{
      "Stops of joints: beyond a limit, by d > 0, the effort K d^n + C d' pushes back, and never pulls.",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       real("lower", "rad or m").left_out("none").about("Smallest c that is free."),
       real("upper", "rad or m").left_out("none").about("Largest c that is free."),
       real("stiffness", "N m/rad^n or N/m^n").above(0).required().about("K."),
       real("damping", "N m s/rad or N s/m").at_least(0).otherwise("0.0").about("C."),
       real("exponent", "").at_least(1).otherwise("1.0").about("n.")},
      ""};
  return keys;
}

const TableKeys& joint_friction_keys() {
  static const TableKeys keys{
      "Dry friction of joints: they stick on a spring up to the effort T_max = s (effort + "
      "friction_coefficient radius F), F the force that the joint transmits, and slide with it; s = 1 + "
      "(static_ratio - 1) exp(-(c'/stribeck_rate)^2).",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       real("effort", "N m or N").at_least(0).otherwise("0.0").about("Friction without load."),
       real("friction_coefficient", "")
           .at_least(0)
           .otherwise("0.0")
           .about("Of the surfaces that the joint's force F presses together; in a translational joint F is "
                  "the force across the axis."),
       real("radius", "m")
           .above(0)
           .left_out("there is no friction_coefficient, or the coordinate is a displacement: 1 in its place")
           .about("Of the pin, or of a screw's thread: where an angle rubs."),
       real("stiffness", "N m/rad or N/m")
           .above(0)
           .required()
           .about("Of the spring on which the joint sticks: it gives way by T_max / stiffness before it "
                  "slides."),
       real("damping", "N m s/rad or N s/m")
           .at_least(0)
           .otherwise("0.0")
           .about("Of a dashpot beside this spring."),
       real("static_ratio", "")
           .at_least(1)
           .otherwise("1.0")
           .about("T_max at rest over that of a fast slide."),
       real("stribeck_rate", "rad/s or m/s")
           .above(0)
           .left_out("static_ratio is 1")
           .about("c' at which the excess of T_max at rest has fallen to 37 %.")},
      ""};
  return keys;
}

const TableKeys& coupler_keys() {
  using Kind = CouplerKind;
  static const TableKeys keys{
      "Couplers: a fixed sum of the coordinates of two or three joints, as gears and belts make it.",
      {name_key().required().about("Name for messages and results."),
       choice<Kind>("type").required().about(
           "With c1, c2, c3 the joints' coordinates, and r1, r2 the radii, what keeps its value of t = 0 is, "
           "for a gear, "
           "c1 + (r2/r1) c2 (internal: -); belt, c1 - (r2/r1) c2; rack and pinion, the pinion first, c2 - "
           "radius c1; "
           "differential, the carrier last, c1 + c2 - 2 c3; sum, the sum of coefficients times coordinates."),
       texts("joints").required().about(
           "The joints (revolute, translational, cylindrical, screw or universal); gears, "
           "belts, differentials and pinions take their angles, a rack its "
           "displacement."),
       texts("coordinates")
           .only_for({Kind::sum})
           .left_out("of each joint the only one, of a screw the angle")
           .about("Per joint what the key coordinate says elsewhere: \"angle\", \"displacement\", "
                  "\"angle_1\" or "
                  "\"angle_2\"."),
       reals("radii", "m")
           .only_for({Kind::gear, Kind::belt})
           .entries(2)
           .required()
           .about("Of the two wheels, or their numbers of teeth."),
       boolean("internal")
           .only_for({Kind::gear})
           .otherwise("false")
           .about("Whether one wheel turns inside the other."),
       real("radius", "m")
           .only_for({Kind::rack_and_pinion})
           .required()
           .about("Of the pinion; below 0 where the rack lies on its other side."),
       reals("coefficients", "")
           .only_for({Kind::sum})
           .required()
           .about("One for each joint, none of them 0; in their units [m/rad] where joints of both kinds are "
                  "coupled.")},
      "type"};
  return keys;
}

}  // namespace scree
