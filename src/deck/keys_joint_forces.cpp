// Keys of motors, springs, limits and friction on joints, and of couplers.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

Key joint_key() {
  return text("joint").required().about(
      "The joint (revolute, translational, cylindrical, screw or universal); or a row of joints: one element "
      "for each, named NAME.0, NAME.1, ...; or a cylinder, whose coordinate is its length. The coordinate c "
      "is the angle of the second body minus that of the first [rad], in space about the axis and counted "
      "beyond full revolutions, or the displacement along the axis [m]. An effort is the generalized force "
      "on c: a torque on an angle, a force on a displacement; above 0 it increases c.");
}

}  // namespace

const TableKeys& motor_keys() {
  static const TableKeys keys{
      "Motors: efforts (generalized forces) on the coordinates of joints: a torque on an angle, a force on a "
      "displacement.",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       choice<MotorKind>("type").required().about(
           "Effort: a function of time. Torque-speed: stall_effort (command - c'/free_rate), the linear "
           "torque-speed curve of a DC motor. Speed: gain e + integral_gain (integral of e over time), e = "
           "rate - c'; the integral is held while the effort is at the limit. Position: position_gain e + "
           "rate_gain e', e = position - c: a servo."),
       real("limit", "N m or N").above(0).left_out("none").about("Largest effort in either direction."),
       quantity("effort", "N m or N", time_function_keys())
           .required()
           .only_for({MotorKind::effort})
           .about("Function of time."),
       real("stall_effort", "N m or N")
           .above(0)
           .required()
           .only_for({MotorKind::line})
           .about("Effort at c' = 0 with command 1."),
       real("free_rate", "rad/s or m/s")
           .above(0)
           .required()
           .only_for({MotorKind::line})
           .about("Rate without load, with command 1."),
       quantity("command", "", time_function_keys())
           .only_for({MotorKind::line})
           .otherwise("1.0")
           .about(
               "Function of time: voltage or throttle as a fraction of its full value; below 0 in reverse."),
       quantity("rate", "rad/s or m/s", time_function_keys())
           .required()
           .only_for({MotorKind::speed})
           .about("Function of time: the demanded rate."),
       real("gain", "N m s/rad or N s/m")
           .above(0)
           .required()
           .only_for({MotorKind::speed})
           .about("Effort per rate error."),
       real("integral_gain", "N m/rad or N/m")
           .only_for({MotorKind::speed})
           .at_least(0)
           .otherwise("0.0")
           .about("Effort per time integral of the rate error. With 0, a load leaves a constant rate error."),
       quantity("position", "rad or m", time_function_keys())
           .required()
           .only_for({MotorKind::position})
           .about("Function of time: the demanded coordinate."),
       real("position_gain", "N m/rad or N/m")
           .above(0)
           .required()
           .only_for({MotorKind::position})
           .about("Effort per position error; a load leaves an error of load / position_gain."),
       real("rate_gain", "N m s/rad or N s/m")
           .only_for({MotorKind::position})
           .at_least(0)
           .otherwise("0.0")
           .about("Effort per rate of the position error: damps the servo.")},
      "type"};
  return keys;
}

const TableKeys& joint_spring_keys() {
  static const TableKeys keys{
      "Springs and dampers on the coordinates of joints: effort = -(k (c - free_coordinate) + d c' + F(c) + "
      "G(c')).",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       real("stiffness", "N m/rad or N/m").at_least(0).otherwise("0.0").about("k."),
       real("damping", "N m s/rad or N s/m").at_least(0).otherwise("0.0").about("d."),
       real("free_coordinate", "rad or m")
           .formerly("free")
           .left_out("c at t = 0")
           .about("c at which the spring k is unloaded."),
       reals("coordinates", "rad or m").left_out("no F").about("Table F: c of its points, increasing."),
       reals("elastic_efforts", "N m or N")
           .left_out("no F")
           .about("Table F: the effort at each point that holds the joint there. Beyond the points F "
                  "continues in a straight line."),
       reals("rates", "rad/s or m/s").left_out("no G").about("Table G: c' of its points, increasing."),
       reals("damping_efforts", "N m or N")
           .left_out("no G")
           .about("Table G: the effort at each point that keeps the joint moving at this rate."),
       choice<Interpolation>("interpolation")
           .otherwise_choice(Interpolation::linear)
           .about("Interpolation of both tables, as for functions of time; not clamped.")},
      ""};
  return keys;
}

const TableKeys& joint_limit_keys() {
  static const TableKeys keys{
      "Stops of joints: at a distance d > 0 beyond a limit, the effort K d^n + C d' pushes back; it never "
      "pulls.",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       real("lower", "rad or m").left_out("none").about("Smallest c within the limits."),
       real("upper", "rad or m").left_out("none").about("Largest c within the limits."),
       real("stiffness", "N m/rad^n or N/m^n").above(0).required().about("K."),
       real("damping", "N m s/rad or N s/m").at_least(0).otherwise("0.0").about("C."),
       real("exponent", "").at_least(1).otherwise("1.0").about("n.")},
      ""};
  return keys;
}

const TableKeys& joint_friction_keys() {
  static const TableKeys keys{
      "Dry friction of joints: stiction is a spring; the joint slides once the effort of the spring reaches "
      "T_max = s (effort + friction_coefficient radius F), F: the force that the joint transmits; s = 1 + "
      "(static_ratio - 1) exp(-(c'/stribeck_rate)^2).",
      {name_key().required().about("Name for messages and results."), joint_key(), coordinate_key(),
       real("effort", "N m or N")
           .at_least(0)
           .otherwise("0.0")
           .about("Friction effort of the unloaded joint."),
       real("friction_coefficient", "")
           .at_least(0)
           .otherwise("0.0")
           .about("Coefficient of friction of the surfaces that the joint force F presses together. In a "
                  "translational joint F is the force perpendicular to the axis."),
       real("radius", "m")
           .above(0)
           .left_out("there is no friction_coefficient, or the coordinate is a displacement: 1 in its place")
           .about("Radius of the pin or of the screw's thread at which friction acts, for an angle."),
       real("stiffness", "N m/rad or N/m")
           .above(0)
           .required()
           .about("Stiffness of the stiction spring. The joint slides at a deflection of T_max / stiffness."),
       real("damping", "N m s/rad or N s/m")
           .at_least(0)
           .otherwise("0.0")
           .about("Damping in parallel with the stiction spring."),
       real("static_ratio", "")
           .at_least(1)
           .otherwise("1.0")
           .about("Ratio of T_max at c' = 0 to T_max at a high rate."),
       real("stribeck_rate", "rad/s or m/s")
           .above(0)
           .left_out("static_ratio is 1")
           .about("c' at which the excess of T_max has fallen to 37 %.")},
      ""};
  return keys;
}

const TableKeys& coupler_keys() {
  using Kind = CouplerKind;
  static const TableKeys keys{
      "Couplers: a linear combination of the coordinates of two or three joints is constant, as in gears and "
      "belts.",
      {name_key().required().about("Name for messages and results."),
       choice<Kind>("type").required().about(
           "c1, c2, c3: the joints' coordinates; r1, r2: the radii. The combination that keeps its value of "
           "t = 0 is for a gear c1 + (r2/r1) c2 (internal: -), a belt c1 - (r2/r1) c2, a rack and pinion "
           "(pinion first) c2 - radius c1, a differential (carrier last) c1 + c2 - 2 c3, a sum the sum of "
           "coefficients times coordinates."),
       texts("joints").required().about(
           "The joints (revolute, translational, cylindrical, screw or universal). Gears, belts, "
           "differentials and pinions use their angles, a rack its displacement."),
       texts("coordinates")
           .only_for({Kind::sum})
           .left_out("for each joint its only coordinate, for a screw the angle")
           .about("Which coordinate of each joint: \"angle\", \"displacement\", \"angle_1\" or \"angle_2\", "
                  "as in the key `coordinate` of other tables."),
       reals("radii", "m")
           .only_for({Kind::gear, Kind::belt})
           .entries(2)
           .required()
           .about("Radii of the two wheels, or their numbers of teeth."),
       boolean("internal")
           .only_for({Kind::gear})
           .otherwise("false")
           .about("Whether one wheel runs inside the other."),
       real("radius", "m")
           .only_for({Kind::rack_and_pinion})
           .required()
           .about("Radius of the pinion; below 0 where the rack is on its other side."),
       reals("coefficients", "")
           .only_for({Kind::sum})
           .required()
           .about("One for each joint, none of them 0; in units such as [m/rad] where angles and "
                  "displacements are coupled.")},
      "type"};
  return keys;
}

}  // namespace scree
