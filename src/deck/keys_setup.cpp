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
       tables("particles", particle_keys())},
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

const TableKeys& contact_keys() {
  static const TableKeys pairs{
      "The contact law of a pair of materials: F = K d^n + C d', d: overlap. Where there is no stiffness and "
      "both materials have a Young's modulus: Hertz's law of spheres, or in 2D a linear law of discs of "
      "thickness L with K = pi/4 E* L.",
      {texts("materials").entries(2).left_out("the only material").about("The two materials, in any order."),
       real("stiffness", "N/m^n")
           .at_least(0)
           .left_out("from the materials' moduli, or from largest_overlap")
           .about("K. 0 with damping 0: the two materials do not interact."),
       real("largest_overlap", "")
           .above(0)
           .within(0, 1)
           .left_out("the stiffness is given")
           .about("In place of stiffness: overlap over radius that an undamped impact at impact_speed "
                  "reaches, for the heaviest particle of the deck and the pair's smallest radius. K = "
                  "(n+1)/2 m* v^2 / d^(n+1), d: that overlap, m*: mass of the heaviest particle, or half of "
                  "it where only particles meet particles."),
       real("impact_speed", "m/s").above(0).left_out("none").about("Impact speed for largest_overlap."),
       real("damping", "N s/m").at_least(0).otherwise("0.0").about("C."),
       real("exponent", "").within(0.5, 4).otherwise("1.0").about("n."),
       real("restitution", "")
           .within(0, 1)
           .above(0)
           .left_out("no damping, as with 1")
           .about("In place of damping: ratio of the speeds after and before a head-on impact, equal at all "
                  "speeds and masses, by C = 2 zeta sqrt(m* K (n+1)/2) d^((n-1)/2), exact with limit_damping "
                  "and without; needs n >= 1. For surfaces with adhesion or attraction it holds for the law "
                  "without these and with limit_damping = false. In m* a body counts as infinitely heavy in "
                  "contacts with particles."),
       boolean("limit_damping")
           .formerly("tension", FormerSense::negated)
           .otherwise("true")
           .about(
               "Whether the damping force is limited so that the total normal force never becomes tensile. "
               "false: the force F = K d^n + C d' may be tensile just before separation, as in the paper."),
       real("friction", "")
           .at_least(0)
           .left_out("no friction")
           .about("Coulomb's coefficient of friction: between particles, of particles on walls and bodies, "
                  "and of bodies on each other and on walls. If any pair has friction, particles rotate."),
       real("tangential_stiffness", "N/m")
           .above(0)
           .left_out("2/7 of a linear stiffness; for Hertz's law Mindlin's, from the shear moduli")
           .about("Stiffness of the tangential spring, which acts until the contact slides."),
       real("tangential_damping_ratio", "")
           .at_least(0)
           .otherwise("0.0")
           .about("Damping ratio of the dashpot in parallel with the tangential spring, relative to critical "
                  "damping of the tangential motion. It acts while the contact sticks, and the sum of both "
                  "forces is limited by friction; it does not act while the contact slides."),
       real("rolling_friction", "")
           .at_least(0)
           .left_out("no rolling resistance")
           .about("mu_r: rolling resistance by a spring up to the moment mu_r R* F (Ai, Chen, Rotter, Ooi, "
                  "2011, model C), R*: reduced radius. mu_r is the tangent of the slope on which a sphere "
                  "begins to roll. Needs friction; 0: none."),
       real("rolling_stiffness", "N m")
           .above(0)
           .left_out("2.25 K mu_r^2 R*^2, in 2D 3 K mu_r^2 R*^2, K: dF/dd")
           .about("Stiffness of the rolling spring."),
       real("rolling_damping_ratio", "")
           .at_least(0)
           .otherwise("0.0")
           .about("Damping ratio of the dashpot in parallel with the rolling spring, within the same limit, "
                  "relative to critical damping."),
       real("rolling_damping", "N m s")
           .at_least(0)
           .left_out("none")
           .about("Coefficient C of a viscous rolling moment C w, w: rolling rate; with the rolling spring "
                  "or without. It holds nothing at rest. Needs friction."),
       real("twisting_friction", "")
           .at_least(0)
           .left_out("friction, where there is rolling resistance in 3D; otherwise no twisting resistance")
           .about("mu of the spring that resists twisting (relative rotation about the normal); it slides at "
                  "the moment 2/3 a mu F, a: contact radius sqrt(R* d) (Marshall, 2009)."),
       real("wear_coefficient", "1/Pa")
           .within(0, 1)
           .left_out("no wear")
           .about("k/H of Archard's law (1953) for the field wear_depth: a mesh loses the volume k/H F s, F: "
                  "normal force, s: sliding distance, computed as the dissipation of friction over the "
                  "coefficient of friction. Shapes do not change. Needs friction above 0."),
       real("work_of_adhesion", "J/m^2")
           .at_least(0)
           .left_out("no adhesion")
           .about(
               "w, for Hertz's law: energy per area to separate the two surfaces. The normal force may then "
               "be tensile with either value of limit_damping, and the friction limit includes the adhesive "
               "force. Explicit steps in double precision only. Adhesion acts between particles and on "
               "particles that touch walls or bodies, not between bodies or between bodies and walls."),
       real("surface_energy", "J/m^2")
           .at_least(0)
           .left_out("work_of_adhesion is given, or no adhesion")
           .about("In place of work_of_adhesion: w/2, of each of two equal surfaces."),
       choice<Adhesion>("adhesion")
           .left_out("jkr")
           .about("With work_of_adhesion. jkr: the contact forms at touch, persists under tension and breaks "
                  "at the pull-off force 3/2 pi w R* (Johnson, Kendall, Roberts, 1971; soft, sticky, large). "
                  "dmt: a constant adhesive force 2 pi w R* while the surfaces touch (Derjaguin, Muller, "
                  "Toporov, 1975; hard, small). All pairs of a deck have the same model."),
       real("attraction", "N")
           .at_least(0)
           .left_out("none")
           .about("A constant attractive force in addition to a linear or Hertz's law, while the two touch."),
       real("attraction_range", "m")
           .above(0)
           .left_out("the attraction ends where the contact opens")
           .about("Distance between the surfaces over which the attraction falls linearly to zero.")},
      ""};
  static const TableKeys keys{
      "Contact laws and contact detection.",
      {real("skin", "m")
           .above(0)
           .left_out("0.2 x the smallest radius at the start; explicit steps in double then choose it")
           .about("Skin of the neighbour list: it contains pairs up to this distance between their surfaces. "
                  "In double no bit depends on it; the program chooses 0.1 to 1 x the smallest radius."),
       boolean("connected_bodies_touch")
           .otherwise("false")
           .about(
               "Whether two bodies that are connected by a joint or force element collide with each other."),
       real("max_start_overlap", "")
           .within(0, 1)
           .otherwise("0.05")
           .about("Limit of the overlap at t = 0 relative to the smaller radius (for a body's mesh on a "
                  "plane, the radius of the sphere with the area of its convex hull). Above it the deck is "
                  "refused; smaller overlaps give a warning."),
       choice<Mixing>("mixing")
           .otherwise_choice(Mixing::none)
           .about("How a pair of materials that can meet and is not given follows from the pairs of each "
                  "material with itself. none: it must be given. Otherwise stiffnesses act in series (K = 2 "
                  "K_a K_b / (K_a + K_b) for two linear laws; Hertz's law uses the materials' moduli: 1/E* = "
                  "sum (1 - nu^2)/E), and damping, damping ratios, restitution, coefficients of friction, "
                  "adhesion and attraction are the geometric, arithmetic or harmonic mean, or the smaller or "
                  "larger value. `scree check` prints the resulting pairs."),
       tables("pairs", pairs)},
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

const TableKeys& material_keys() {
  static const TableKeys keys{
      "Materials. Without any, there is one named \"default\".",
      {name_key().required().about("Name that bodies, particles, walls and contact pairs refer to."),
       real("density", "kg/m^3")
           .above(0)
           .left_out("none")
           .about("For particles that have neither mass nor density."),
       real("young_modulus", "Pa")
           .above(0)
           .left_out("none")
           .about("With poisson_ratio: pairs of such materials follow Hertz's law."),
       real("poisson_ratio", "").within(-1, 0.5).above(-1).left_out("none").about("With young_modulus.")},
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
