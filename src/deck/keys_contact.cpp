// Keys of contact laws, contact detection and materials.
#include "deck/choices.hpp"
#include "deck/keys.hpp"
#include "deck/pair_laws.hpp"

namespace scree {

namespace {

// Normal force of a pair. The keys of laws that add to it, and of friction and rolling resistance, are in
// their files (deck/pair_laws.hpp).
std::vector<Key> normal_keys() {
  return {
      texts("materials")
          .entries(2)
          .left_out("the only material")
          .combined(Combining::other)
          .about("The two materials, in any order."),
      real("stiffness", "N/m^n")
          .at_least(0)
          .left_out("from the materials' moduli, or from largest_overlap")
          .combined(Combining::other)
          .about("K. 0 with damping 0: the two materials do not interact."),
      real("largest_overlap", "")
          .above(0)
          .within(0, 1)
          .left_out("the stiffness is given")
          .combined(Combining::same)
          .about("In place of stiffness: overlap over radius that an undamped impact at impact_speed "
                 "reaches, for the heaviest particle of the deck and the pair's smallest radius. K = "
                 "(n+1)/2 m* v^2 / d^(n+1), d: that overlap, m*: mass of the heaviest particle, or half of "
                 "it where only particles meet particles."),
      real("impact_speed", "m/s")
          .above(0)
          .left_out("none")
          .combined(Combining::same)
          .about("Impact speed for largest_overlap."),
      real("damping", "N s/m").at_least(0).otherwise("0.0").combined(Combining::mean).about("C."),
      real("exponent", "").within(0.5, 4).otherwise("1.0").combined(Combining::same).about("n."),
      real("restitution", "")
          .within(0, 1)
          .above(0)
          .left_out("no damping, as with 1")
          .combined(Combining::other)
          .about("In place of damping: ratio of the speeds after and before a head-on impact, equal at all "
                 "speeds and masses, by C = 2 zeta sqrt(m* K (n+1)/2) d^((n-1)/2), exact with limit_damping "
                 "and without; needs n >= 1. For surfaces with adhesion or attraction it holds for the law "
                 "without these and with limit_damping = false. m* includes the mass and the rotation of "
                 "bodies at the contact, as if they had no joints."),
      boolean("limit_damping")
          .formerly("tension", FormerSense::negated)
          .otherwise("true")
          .combined(Combining::same)
          .about(
              "Whether the damping force is limited so that the total normal force never becomes tensile. "
              "false: the force F = K d^n + C d' may be tensile just before separation, as in the paper.")};
}

const TableKeys& pair_keys() {
  static const TableKeys keys = [] {
    TableKeys pairs{
        "The contact law of a pair of materials: F = K d^n + C d', d: overlap. Where there is no stiffness "
        "and "
        "both materials have a Young's modulus: Hertz's law of spheres, or in 2D a linear law of discs of "
        "thickness L with K = pi/4 E* L.",
        normal_keys(), ""};
    for (const PairLaw& law : pair_laws()) {
      const std::vector<Key> more = law.keys();
      pairs.keys.insert(pairs.keys.end(), more.begin(), more.end());
    }
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
