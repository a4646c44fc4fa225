// Keys of everything but the bodies and the particles.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

Key boundary(const std::string& name, const std::string& side) {
  return choice<Boundary>(name)
      .otherwise_choice(Boundary::open)
      .about("Boundary on the side of " + side + "; \"periodic\" must be on both sides of an axis.");
}

}  // namespace

const TableKeys& deck_keys() {
  static const TableKeys keys{
      "",
      {text("title").otherwise("\"\"").about("Name of the case, written into the results."),
       table("space", space_keys()).required(),
       vector("gravity", "m/s^2").otherwise("zero").about("Acceleration of gravity."),
       choice<StartVelocities>("velocities")
           .otherwise_choice(StartVelocities::given)
           .about("Velocities of the bodies at t = 0. Given: as the bodies' keys say; the run is refused "
                  "where they contradict a joint or driver, with a message that names the keys to set and "
                  "their values. Consistent: corrected to agree with all joints and drivers; the correction "
                  "has the least kinetic energy."),
       table("time", time_keys()).required(),
       table("integrator", integrator_keys()),
       table("contact", contact_keys()),
       table("output", output_keys()),
       tables("stop", stop_keys()),
       table("parallel", parallel_keys()),
       tables("materials", material_keys()),
       tables("meshes", mesh_keys()),
       tables("walls", wall_keys()),
       tables("bodies", body_keys()),
       tables("markers", marker_keys()),
       tables("joints", joint_keys()),
       tables("drivers", driver_keys()),
       tables("cylinders", cylinder_keys()),
       tables("spring_dampers", spring_damper_keys()),
       tables("torsional_spring_dampers", torsional_spring_damper_keys()),
       tables("bushings", bushing_keys()),
       tables("applied_forces", applied_force_keys()),
       tables("motors", motor_keys()),
       tables("joint_springs", joint_spring_keys()),
       tables("joint_limits", joint_limit_keys()),
       tables("joint_frictions", joint_friction_keys()),
       tables("couplers", coupler_keys()),
       tables("particles", particle_keys()),
       tables("inserters", inserter_keys()),
       tables("outlets", outlet_keys())},
      ""};
  return keys;
}

const TableKeys& space_keys() {
  static const TableKeys keys{
      "The simulation domain.",
      {integer("dimension").within(2, 3).required().about("2: discs in the x-y plane; 3: spheres."),
       vector("min", "m").required().about("Lower corner."),
       vector("max", "m").required().about("Upper corner."), boundary("x_min", "smallest x"),
       boundary("x_max", "largest x"), boundary("y_min", "smallest y"), boundary("y_max", "largest y"),
       boundary("z_min", "smallest z (3D)"), boundary("z_max", "largest z (3D)"),
       text("wall_material").left_out("the only material").about("Material of the sides that are walls."),
       choice<OutsidePolicy>("leaving")
           .otherwise_choice(OutsidePolicy::error)
           .about("What happens to a particle whose centre leaves through an open side. error: the run "
                  "fails. remove: the particle is removed and counted. ballistic: the particle is counted "
                  "and moves under gravity alone, without contacts.")},
      ""};
  return keys;
}

const TableKeys& time_keys() {
  static const TableKeys keys{
      "Simulated time and step control.",
      {real("end", "s").above(0).required().about("The simulation runs from 0 to this time."),
       real("step", "s")
           .above(0)
           .left_out("velocity-verlet: chosen from the deck's contacts so that trial impacts rebound within "
                     "2 % and the step is stable (input/choosing.md); hht, adaptive: the smaller of 1/20 of "
                     "the minimum contact time and end / 1000; hht, fixed: must be given")
           .about("Step size; the initial one with control = \"adaptive\". A chosen step is printed by scree "
                  "check and in the log, and is part of the resolved deck."),
       choice<StepControl>("control")
           .otherwise_choice(StepControl::adaptive)
           .otherwise_where("integrator.particles", ParticleIntegrator::velocity_verlet, StepControl::fixed)
           .about("Fixed: all steps are equal. Adaptive: the estimated local error is kept within tolerance. "
                  "velocity-verlet, given or chosen, has no error estimate and needs fixed steps."),
       real("min_step", "s")
           .above(0)
           .left_out("step / 1e3 if fixed; step / 1e6 if adaptive")
           .about("The run fails where a smaller step would be needed, also when a step is retried."),
       real("max_step", "s")
           .only_for({StepControl::adaptive})
           .above(0)
           .left_out("the smaller of end / 100 and the time in which a particle falling across the domain "
                     "would move by half of the smallest radius; but at least step")
           .about("Largest step."),
       real("tolerance", "")
           .only_for({StepControl::adaptive})
           .within(0, 1)
           .above(0)
           .otherwise("2e-8")
           .about("Allowed local error of a position per step: for a particle relative to its radius, for a "
                  "body relative to the length of the mechanism.")},
      "control"};
  return keys;
}

const TableKeys& integrator_keys() {
  static const TableKeys keys{
      "Time integration and its Newton iteration.",
      {boolean("corrected_start")
           .otherwise("true")
           .about("For spatial bodies: the first step starts from accelerations and velocities that are "
                  "consistent with the integration scheme, so that the reactions within the steps, on which "
                  "joint friction depends, are of second order from the start."),
       real("hht_alpha", "")
           .within(-1.0 / 3, 0)
           .otherwise("-0.05")
           .about("Numerical damping of the HHT scheme, for bodies and particles. With adaptive steps it "
                  "does not reduce the accuracy of impacts. With fixed steps far above a tenth of the "
                  "contact time, 0 (no damping) has the smallest error at weak contact damping. Without "
                  "numerical damping, long runs of chains of joints fail."),
       choice<RedundantRows>("redundant")
           .otherwise_choice(RedundantRows::error)
           .about("Redundant constraints of joints and drivers, as in every planar loop of revolute joints "
                  "in space. error: the run is refused and the message names them. minimum-norm: the motion "
                  "is unique, and the reactions are the minimum-norm solution, weighted with the bodies' "
                  "mobility."),
       choice<ParticleIntegrator>("particles")
           .otherwise_automatic()
           .about("Integrator of the particles: implicit (hht) or explicit (velocity-verlet). Bodies always "
                  "use HHT. auto: explicit where contacts have rolling resistance or adhesion, and from 20 "
                  "particles in possible contact on with friction, or 50 without. Otherwise implicit; also "
                  "where the deck has keys that only implicit steps use (control = \"adaptive\", tolerance, "
                  "max_step, contact_events) or a step too long for explicit ones. substeps above 1 and "
                  "precision = \"mixed\" make it explicit. The choice is printed by scree check and in the "
                  "log, and is part of the resolved deck."),
       choice<ContactEvents>("contact_events")
           .otherwise_choice(ContactEvents::resolved)
           .about(
               "For hht. resolved: a contact that opens or closes within a step acts over its part of the "
               "step. end-of-step: the force at the end of the step acts over all of it, as in the paper."),
       integer("substeps")
           .within(1, 1000000)
           .otherwise("1")
           .about("Velocity-verlet steps of the particles per step of the bodies."),
       choice<Precision>("precision")
           .otherwise_choice(Precision::full)
           .about("GPU, velocity-verlet. mixed: state and sums at about double precision, contact forces in "
                  "single. With adhesion or shapes of bodies, and on the CPU, everything is computed in "
                  "double, and the log says so."),
       real("residual_tolerance", "")
           .within(0, 1)
           .above(0)
           .otherwise("1e-8")
           .about("Convergence tolerance of the Newton iteration: scaled residual."),
       real("correction_tolerance", "")
           .within(0, 1)
           .above(0)
           .otherwise("1e-8")
           .about("Convergence tolerance of the Newton iteration: correction of a position relative to the "
                  "particle's radius."),
       integer("max_iterations")
           .within(1, 10000)
           .otherwise("50")
           .about("Largest number of Newton iterations of a step before it is retried with a smaller step.")},
      ""};
  return keys;
}

const TableKeys& parallel_keys() {
  static const TableKeys keys{
      "How particles are distributed over the MPI ranks. Results do not depend on it.",
      {real("imbalance", "")
           .at_least(0)
           .otherwise("0.2")
           .about("The subdomains are balanced anew where the largest work of a rank exceeds the mean by "
                  "more than this fraction."),
       choice<Transport>("transport")
           .otherwise_choice(Transport::automatic)
           .about("How ghost data are sent between GPUs: into each other's memory within one host (peer), by "
                  "an MPI library that takes device memory, by NCCL, or through host memory. auto: the first "
                  "that works. Another one that does not work ends the run.")},
      ""};
  return keys;
}

const TableKeys& wall_motion_keys() {
  using Kind = WallMotionKind;
  static const TableKeys keys{
      "Prescribed motions of a wall, whatever touches it, applied one after the other, along directions and "
      "about axes that are fixed in the global frame. At t = 0 the wall is where the deck places it: only "
      "the change of a function of time since t = 0 counts.",
      {choice<Kind>("type").required().about(
           "Translation: by displacement along direction. Rotation: by angle about an axis."),
       vector("direction", "")
           .only_for({Kind::translation})
           .required()
           .about("Direction, of any length but 0."),
       quantity("displacement", "m", time_function_keys())
           .only_for({Kind::translation})
           .required()
           .about("Function of time; tables as for the motion of a driver."),
       vector("axis", "")
           .only_for({Kind::rotation})
           .left_out("z in 2D; in 3D it must be given")
           .about("Axis, right-handed, of any length but 0."),
       vector("point", "m").only_for({Kind::rotation}).required().about("Any point of the axis."),
       quantity("angle", "rad", time_function_keys())
           .only_for({Kind::rotation})
           .required()
           .about("Function of time; tables as for the motion of a driver.")},
      "type"};
  return keys;
}

const TableKeys& wall_keys() {
  static const TableKeys keys{
      "Walls inside the domain: planes with solid behind them, or meshes. Contacts do not move a wall; a "
      "wall that responds to them is a body with a joint.",
      {name_key().required().about("Name for messages and output.history_contacts."),
       vector("point", "m").left_out("mesh is given").about("Any point of the plane."),
       vector("normal", "")
           .left_out("mesh is given")
           .about("Direction into the free side, of any length but 0, perpendicular to periodic axes."),
       text("mesh")
           .left_out("point and normal are given")
           .about("Name of one of the meshes, in place of a plane; its frame is the global one at t = 0."),
       text("material").left_out("the only material").about("Material of the wall."),
       tables("motions", wall_motion_keys()),
       vector("surface_velocity", "m/s")
           .left_out("the surface moves as the wall")
           .about("Tangential velocity of the surface while the wall itself does not move, as that of a "
                  "conveyor belt. The vector is fixed to the wall; its part tangential to the surface at "
                  "each contact counts, and for a plane it must be parallel to the plane. It acts by "
                  "friction only.")},
      ""};
  return keys;
}

}  // namespace scree
