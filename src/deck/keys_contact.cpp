// Keys of contact laws, contact detection and materials.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

// Attraction of the two surfaces, in addition to the other keys of their pair.
std::vector<Key> attraction_keys() {
  return {
      real("work_of_adhesion", "J/m^2")
          .at_least(0)
          .left_out("no adhesion")
          .about(
              "w, for Hertz's law: energy per area to separate the two surfaces. The normal force may then "
              "be tensile with either value of limit_damping, and the friction limit includes the adhesive "
              "force. JKR and plastic contacts need explicit steps, and all adhesion double precision. "
              "Adhesion acts on particles and on the discs and spheres on bodies, not on the corners of a "
              "body's mesh on a plane."),
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
          .about("Distance between the surfaces over which the attraction falls linearly to zero. Explicit "
                 "steps only.")};
}

// Plasticity of a pair.
std::vector<Key> plasticity_keys() {
  return {
      real("plasticity_ratio", "")
          .within(0, 0.999)
          .left_out("the contact is elastic, as with 0")
          .about(
              "l = 1 - k1/k2: elasto-plastic adhesion (Edinburgh elasto-plastic adhesion model, EEPA) with "
              "the stiffness k1 of loading, K or Hertz's, and k2 of unloading; d_p: plastic overlap. "
              "Without adhesion and damping the restitution is sqrt(1 - l) with a linear stiffness. Beside "
              "it work_of_adhesion is the g of the pull-off force 3/2 pi g a, a = sqrt(2 R* d_p - d_p^2) "
              "(what other programs call surface energy), but at most half of k2 d_p^n; attraction is a "
              "constant force, -f0; restitution is that of the damper alone. Explicit steps in double "
              "precision only. A pair without it, or with 0, may have an attraction, but no other "
              "adhesion."),
      real("adhesion_exponent", "")
          .within(1, 5)
          .left_out("the exponent of the stiffness: 1, or 1.5 with Hertz's law")
          .about("chi, with plasticity_ratio: the adhesive force falls with d^chi when the contact is drawn "
                 "off. A multiple of 0.5, and at least the exponent of the stiffness.")};
}

// Normal force, friction, rolling resistance and wear of a pair.
std::vector<Key> law_keys() {
  return {
      texts("materials").entries(2).left_out("the only material").about("The two materials, in any order."),
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
                 "without these and with limit_damping = false. m* includes the mass and the rotation of "
                 "bodies at the contact, as if they had no joints."),
      boolean("limit_damping")
          .formerly("tension", FormerSense::negated)
          .otherwise("true")
          .about("Whether the damping force is limited so that the total normal force never becomes tensile. "
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
                 "coefficient of friction. Shapes do not change. Needs friction above 0.")};
}

// Liquid bridges between the two surfaces, likewise.
std::vector<Key> bridge_keys() {
  return {
      real("bridge_volume", "")
          .within(0, 0.1)
          .left_out("no liquid bridges")
          .about("Volume of each liquid bridge over the cube of the smaller radius, constant. A bridge forms "
                 "when the surfaces touch, pulls with 2 pi R gamma cos(theta), R = 2 R*, and acts across a "
                 "gap up to (1 + theta/2) V^(1/3), where it breaks. Beside a linear law or Hertz's, in "
                 "explicit steps in "
                 "double precision. 0: none."),
      real("surface_tension", "N/m")
          .at_least(0)
          .left_out("no liquid bridges")
          .about("gamma of the liquid; of water in air 0.0728 N/m at 20 C. Needs bridge_volume."),
      real("contact_angle", "rad")
          .within(0, 1.5)
          .left_out("0")
          .about("theta between liquid and surfaces, the same on both."),
      choice<BridgeForce>("bridge_force")
          .left_out("willett")
          .about(
              "Force of a bridge over its gap S. willett: 1 / (1 + 1.05 s + 2.5 s^2) of that at touch, s = "
              "S sqrt(R / V) (Willett et al., 2000). soulie: exponential, fitted to spheres of unequal "
              "radii (Soulie et al., 2006); against surfaces of walls and meshes as willett."),
      real("bridge_viscosity", "Pa s")
          .at_least(0)
          .left_out("no viscous force")
          .about("mu of the liquid, for the normal viscous force 6 pi mu R* v / max(s_min, S/R*) while "
                 "there is a bridge; of water 1e-3 Pa s. It adds to the damping of the contact."),
      real("bridge_least_gap", "")
          .within(0, 1)
          .above(0)
          .left_out("0.01")
          .about("s_min: the gap over R* below which the viscous force does not grow, for example the "
                 "roughness of the surfaces.")};
}

const TableKeys& pair_keys() {
  static const TableKeys keys = [] {
    TableKeys pairs{
        "The contact law of a pair of materials: F = K d^n + C d', d: overlap. Where there is no stiffness "
        "and "
        "both materials have a Young's modulus: Hertz's law of spheres, or in 2D a linear law of discs of "
        "thickness L with K = pi/4 E* L.",
        law_keys(), ""};
    for (const std::vector<Key>& more : {attraction_keys(), plasticity_keys(), bridge_keys()})
      pairs.keys.insert(pairs.keys.end(), more.begin(), more.end());
    return pairs;
  }();
  return keys;
}

}  // namespace

const TableKeys& contact_keys() {
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
                  "adhesion, plasticity ratios and attraction are the geometric, arithmetic or harmonic "
                  "mean, or the smaller or "
                  "larger value. `scree check` prints the resulting pairs."),
       tables("pairs", pair_keys())},
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

}  // namespace scree
