// Keys of everything but the bodies and the particles.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

Key boundary(const std::string& name, const std::string& side) {
  return choice<Boundary>(name)
      .otherwise_choice(Boundary::open)
      .about("Boundary on the side of " + side + "; \"periodic\" must stand on both sides of an axis.");
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
           .about(
               "Of the bodies at t = 0. Given: as the bodies' keys say; the run is refused where a joint or "
               "driver contradicts them, and told which keys to set to what. Consistent: changed so that "
               "they agree with all joints and drivers, by as little as possible in the kinetic energy of "
               "the change."),
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
      "The box that is simulated.",
      {integer("dimension").within(2, 3).required().about("2: discs in the x-y plane; 3: spheres."),
       vector("min", "m").required().about("Lower corner."),
       vector("max", "m").required().about("Upper corner."), boundary("x_min", "smallest x"),
       boundary("x_max", "largest x"), boundary("y_min", "smallest y"), boundary("y_max", "largest y"),
       boundary("z_min", "smallest z (3D)"), boundary("z_max", "largest z (3D)"),
       text("wall_material").left_out("the only material").about("Material of the sides that are walls."),
       choice<Leaving>("leaving")
           .otherwise_choice(Leaving::error)
           .about("What happens to a particle whose centre leaves through an open side: the run fails; it is "
                  "removed and counted; it is counted and drifts on under gravity alone.")},
      ""};
  return keys;
}

const TableKeys& time_keys() {
  static const TableKeys keys{
      "Simulated time and step control.",
      {real("end", "s").above(0).required().about("The simulation runs from 0 to this time."),
       real("step", "s")
           .above(0)
           .left_out("velocity-verlet: chosen from the deck's contacts, so that trial impacts rebound within "
                     "2 % and the step is stable (input/choosing.md); hht, adaptive: 1/20 of the briefest "
                     "contact or end / 1000, whichever is less; hht, fixed: must be given")
           .about("Step size; the first one if control is \"adaptive\". A step that is chosen stands in the "
                  "output of scree check, in the log and in the resolved deck."),
       choice<StepControl>("control")
           .otherwise_choice(StepControl::adaptive)
           .otherwise_where("integrator.particles", ParticleIntegrator::velocity_verlet, StepControl::fixed)
           .about(
               "Fixed step, or steps that keep the estimated local error within tolerance; velocity-verlet, "
               "named or chosen, has no error estimate and fixed steps."),
       real("min_step", "s")
           .above(0)
           .left_out("step / 1e3 if fixed; step / 1e6 if adaptive")
           .about("The run fails where a step would have to be smaller, also when a step is retried."),
       real("max_step", "s")
           .only_for({StepControl::adaptive})
           .above(0)
           .left_out("end / 100 or, if less, the time in which a particle that fell through the space "
                     "would go half of the smallest radius; but at least step")
           .about("Largest step."),
       real("tolerance", "")
           .only_for({StepControl::adaptive})
           .within(0, 1)
           .above(0)
           .otherwise("2e-8")
           .about("Allowed local error of a position per step: a particle's over its radius, a body's over "
                  "the length of the mechanism.")},
      "control"};
  return keys;
}

const TableKeys& integrator_keys() {
  static const TableKeys keys{
      "Time integration and its Newton-like iteration.",
      {boolean("corrected_start")
           .otherwise("true")
           .about("Of spatial bodies: the first step starts from accelerations and velocities that the "
                  "method itself would have, so that the reactions within the steps, which load friction, "
                  "are of second order from the start."),
       real("hht_alpha", "")
           .within(-1.0 / 3, 0)
           .otherwise("-0.05")
           .about("HHT's numerical damping of bodies and particles. With adaptive steps it costs impacts no "
                  "accuracy; with fixed ones far above a tenth of a contact 0, which has none, errs least at "
                  "weak contact damping. Without it long runs of chains of joints fail."),
       choice<RedundantRows>("redundant")
           .otherwise_choice(RedundantRows::error)
           .about("Joints and drivers that fix the same motion more than once, as every planar loop of "
                  "hinges in space does: refused by name, or they share the load. The motion is the same "
                  "whichever of them carry it; the reactions are then the least ones, weighted by the "
                  "bodies' mobility."),
       choice<ParticleIntegrator>("particles")
           .otherwise_automatic()
           .about("Integrator of the particles: implicit, or explicit. Bodies always use HHT. auto: explicit "
                  "where contacts resist rolling or attract, and from 20 particles that may touch on with "
                  "friction, or 50 without; else, and where the deck names what only implicit steps have "
                  "(control = \"adaptive\", tolerance, max_step, contact_events) or a step too long for "
                  "explicit ones, implicit; substeps above 1 and precision = \"mixed\" make it explicit. The "
                  "choice stands in the output of scree check, in the log and in "
                  "the resolved deck."),
       choice<ContactEvents>("contact_events")
           .otherwise_choice(ContactEvents::resolved)
           .about("Hht: a contact that opens or closes within a step acts over its part of the step, or (the "
                  "paper) with the force at the step's end over all of it."),
       integer("substeps")
           .within(1, 1000000)
           .otherwise("1")
           .about("Velocity-verlet steps of the particles per step of the bodies."),
       choice<Precision>("precision")
           .otherwise_choice(Precision::full)
           .about("GPU, velocity-verlet: mixed keeps state and sums at about double precision and computes "
                  "contact forces in single. All in double, and the run says so, where contacts attract or "
                  "resist rolling, where bodies have shapes, and on the CPU."),
       real("residual_tolerance", "")
           .within(0, 1)
           .above(0)
           .otherwise("1e-8")
           .about("Of the iteration: scaled residual."),
       real("correction_tolerance", "")
           .within(0, 1)
           .above(0)
           .otherwise("1e-8")
           .about("Of the iteration: correction of a position over the particle's radius."),
       integer("max_iterations").within(1, 10000).otherwise("50").about("Of a step, before it is retried.")},
      ""};
  return keys;
}

const TableKeys& contact_keys() {
  static const TableKeys pairs{
      "The contact law of a pair of materials: F = K d^n + C d', d: overlap; or, where there is no stiffness "
      "and both materials have a Young's modulus, Hertz's law of spheres, in 2D K = pi/4 E* L of discs of "
      "thickness L.",
      {texts("materials").entries(2).left_out("the only material").about("The two materials, in any order."),
       real("stiffness", "N/m^n")
           .at_least(0)
           .left_out("from the materials' moduli, or from largest_overlap")
           .about("K; 0 with damping 0: the two do not interact."),
       real("largest_overlap", "")
           .above(0)
           .within(0, 1)
           .left_out("the stiffness is given")
           .about(
               "In place of stiffness: overlap over the radius that an undamped impact at impact_speed may "
               "reach, of the deck's heaviest particle and the pair's smallest radius d: K = (n+1)/2 m* "
               "v^2 / d^(n+1), m* half that mass where particles meet particles alone."),
       real("impact_speed", "m/s").above(0).left_out("none").about("With largest_overlap."),
       real("damping", "N s/m").at_least(0).otherwise("0.0").about("C."),
       real("exponent", "").within(0.5, 4).otherwise("1.0").about("n."),
       real("restitution", "")
           .within(0, 1)
           .above(0)
           .left_out("no damping, as with 1")
           .about(
               "In place of damping: speed after over speed before a head-on impact, the same at every speed "
               "and mass, by C = 2 zeta sqrt(m* K (n+1)/2) d^((n-1)/2), exact for either `tension`; needs n "
               "of at least 1. Of surfaces that attract, that of the law without attraction, with tension. A "
               "body that particles meet counts as unmovable in it."),
       boolean("tension").otherwise("false").about(
           "Whether the force may pull just before separation; false cuts it at zero."),
       real("friction", "")
           .at_least(0)
           .left_out("contacts do not rub")
           .about("Coulomb's coefficient of friction between particles, and of particles on walls and on "
                  "bodies, and of these on each other and on walls. Where a pair has one particles rotate."),
       real("tangential_stiffness", "N/m")
           .above(0)
           .left_out("2/7 of a linear stiffness; for Hertz's law Mindlin's, from the shear moduli")
           .about("Of the spring that holds a contact until it slides."),
       real("tangential_damping_ratio", "")
           .at_least(0)
           .otherwise("0.0")
           .about("Of the dashpot beside that spring, over the critical damping of a slip. It acts while the "
                  "spring holds, with their sum within the limit of friction, and not while the contact "
                  "slides."),
       real("rolling_friction", "")
           .at_least(0)
           .left_out("nothing resists rolling")
           .about(
               "mu_r: a spring resists rolling until its moment is mu_r R* F (Ai, Chen, Rotter, Ooi, 2011, "
               "model C), R* the reduced radius: tan of the slope on which a sphere begins to roll. Needs "
               "friction beside it; 0: as if left out."),
       real("rolling_stiffness", "N m")
           .above(0)
           .left_out("2.25 K mu_r^2 R*^2, in 2D 3 K mu_r^2 R*^2, K: dF/dd")
           .about("Of that spring, per radian."),
       real("rolling_damping_ratio", "")
           .at_least(0)
           .otherwise("0.0")
           .about("Of the dashpot beside that spring, within its limit, over critical damping."),
       real("rolling_damping", "N m s")
           .at_least(0)
           .left_out("none")
           .about("A moment against the rate of rolling, C w, beside that spring or alone; nothing holds at "
                  "rest by it. Needs friction beside it."),
       real("twisting_friction", "")
           .at_least(0)
           .left_out("friction, where something resists rolling in 3D; else nothing resists twisting")
           .about("mu of the spring against spinning about the normal, which slides at 2/3 a mu F, a: radius "
                  "of contact, sqrt(R* d) (Marshall, 2009)."),
       real("wear_coefficient", "1/Pa")
           .within(0, 1)
           .left_out("nothing wears")
           .about("k/H of Archard's law (1953) for the output's wear_depth: the volume that a mesh loses is "
                  "k/H F s, F: normal force, s: the way that slides, found as the work of friction over F's "
                  "coefficient. No shape changes. Needs friction above 0 beside it."),
       real("work_of_adhesion", "J/m^2")
           .at_least(0)
           .left_out("the two do not stick")
           .about(
               "w, beside Hertz's law: what parting the two surfaces takes. What attracts may pull, whatever "
               "`tension` says, and friction counts the pull as load. In explicit steps, double precision. "
               "Particles are attracted by each other and by all that they touch; bodies attract neither "
               "each other nor walls."),
       real("surface_energy", "J/m^2")
           .at_least(0)
           .left_out("work_of_adhesion is given, or none")
           .about("In place of work_of_adhesion: w/2, of one of two surfaces that are alike."),
       choice<Adhesion>("adhesion")
           .left_out("jkr")
           .about(
               "With work_of_adhesion. Jkr: a neck that is made at touch and holds down to a pull of 3/2 pi "
               "w R* (Johnson, Kendall, Roberts, 1971; soft, sticky, large). Dmt: a pull of 2 pi w R* while "
               "they touch (Derjaguin, Muller, Toporov, 1975; hard, small). One of them in a deck."),
       real("attraction", "N")
           .at_least(0)
           .left_out("none")
           .about("A constant pull beside a linear law, or Hertz's, while the two touch."),
       real("attraction_range", "m")
           .above(0)
           .left_out("the attraction ends with touch")
           .about("Beyond touch the attraction falls evenly to zero over this distance.")},
      ""};
  static const TableKeys keys{
      "Contact laws and the pair search.",
      {real("skin", "m")
           .above(0)
           .left_out("0.2 x the smallest radius")
           .about("The neighbour list reaches this far past touching."),
       boolean("connected_bodies_touch")
           .otherwise("false")
           .about("Whether two bodies that a joint or force element connects collide with each other."),
       real("max_start_overlap", "")
           .within(0, 1)
           .otherwise("0.05")
           .about("Overlap at t = 0 over the smaller radius (of a body's mesh on a plane that of a sphere of "
                  "the "
                  "area of its convex hull): an error past this limit, a warning below it."),
       choice<Mixing>("mixing")
           .otherwise_choice(Mixing::none)
           .about(
               "How a pair of materials that can meet and is not given follows from those of each with "
               "itself: "
               "none, it must be given. Else springs act in series (K = 2 K_a K_b / (K_a + K_b) of two "
               "linear "
               "ones; Hertz's law takes the materials' moduli: 1/E* = sum (1 - nu^2)/E), and damping, "
               "damping "
               "ratios, restitution, coefficients of friction, adhesion and attraction are the mean of the "
               "two "
               "that is named (geometric, arithmetic, harmonic), or the smaller or larger one. `scree check` "
               "prints what was made."),
       tables("pairs", pairs)},
      ""};
  return keys;
}

const TableKeys& parallel_keys() {
  static const TableKeys keys{
      "How the particles are spread over the ranks of mpirun; no result depends on it.",
      {real("imbalance", "")
           .at_least(0)
           .otherwise("0.2")
           .about(
               "The ranks' boxes are cut anew where the largest work of a rank is more than this share above "
               "the mean."),
       choice<Transport>("transport")
           .otherwise_choice(Transport::automatic)
           .about("How ghosts travel between GPUs: by an MPI library that takes device memory, by NCCL, or "
                  "through host memory. auto: the first of these that works here; another that does not work "
                  "here ends a run that would take GPUs on several ranks.")},
      ""};
  return keys;
}

const TableKeys& material_keys() {
  static const TableKeys keys{
      "Materials. Without any, there is one that is named \"default\".",
      {name_key().required().about("Name that bodies, particles, walls and contact pairs refer to."),
       real("density", "kg/m^3")
           .above(0)
           .left_out("none")
           .about("For particles that give neither mass nor density."),
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
      "How a wall moves, whatever touches it: one motion after the other, each on what those before it "
      "leave, "
      "along directions and about axes that the global frame keeps. At t = 0 the wall is where the deck puts "
      "it: of a function of time its change since then counts.",
      {choice<Kind>("type").required().about(
           "Translation: by displacement along direction. Rotation: by angle about an axis."),
       vector("direction", "").only_for({Kind::translation}).required().about("Of any length but 0."),
       quantity("displacement", "m", time_function_keys())
           .only_for({Kind::translation})
           .required()
           .about("Function of time; tables as for the motion of a driver."),
       vector("axis", "")
           .only_for({Kind::rotation})
           .left_out("z in 2D; in 3D it must be given")
           .about("Right-handed, of any length but 0."),
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
      "Walls inside the space: planes, solid behind them, or meshes. Nothing that touches a wall moves it; "
      "one "
      "that is to respond is a body on a joint.",
      {name_key().required().about("Name for messages and output.history_contacts."),
       vector("point", "m").left_out("mesh is given").about("Any point of the plane."),
       vector("normal", "")
           .left_out("mesh is given")
           .about("Direction into the free side, of any length but 0, across no periodic axis."),
       text("mesh")
           .left_out("point and normal are given")
           .about("Name of one of the meshes, in place of a plane; its frame is the global one at t = 0."),
       text("material").left_out("the only material").about("Material of the wall."),
       tables("motions", wall_motion_keys()),
       vector("surface_velocity", "m/s")
           .left_out("the surface moves as the wall")
           .about(
               "How fast the surface runs along itself while the wall stays, as a conveyor's belt does: of "
               "this vector, fixed to the wall, the part along the surface at each contact; of a plane it "
               "must be along the plane. It acts by friction alone.")},
      ""};
  return keys;
}

}  // namespace scree
