// Friction of a pair of materials.
#include "deck/pair_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

namespace {

std::vector<Key> keys() {
  return {
      real("friction", "")
          .at_least(0)
          .left_out("no friction")
          .combined(Combining::mean)
          .about("Coulomb's coefficient of friction: between particles, of particles on walls and bodies, "
                 "and of bodies on each other and on walls. If any pair has friction, particles rotate."),
      real("tangential_stiffness", "N/m")
          .above(0)
          .left_out("2/7 of a linear stiffness; for Hertz's law Mindlin's, from the shear moduli")
          .combined(Combining::other)
          .about("Stiffness of the tangential spring, which acts until the contact slides."),
      real("tangential_damping_ratio", "")
          .at_least(0)
          .otherwise("0.0")
          .combined(Combining::mean)
          .about("Damping ratio of the dashpot in parallel with the tangential spring, relative to critical "
                 "damping of the tangential motion. It acts while the contact sticks, and the sum of both "
                 "forces is limited by friction; it does not act while the contact slides.")};
}

// G* of two materials with a Young's modulus [Pa].
Real shear_modulus(const DeckTable& a, const DeckTable& b) {
  return effective_shear_modulus(a.real("young_modulus"), a.real("poisson_ratio"), b.real("young_modulus"),
                                 b.real("poisson_ratio"));
}

void take(const PairInDeck& pair, PairParameters& parameters) {
  const DeckTable& table = pair.table;
  const NormalLawParameters& law = parameters.normal;
  if (!table.has("friction")) {
    if (table.has("tangential_stiffness")) table.fail("tangential_stiffness", "needs friction");
    if (table.real("tangential_damping_ratio") > 0) table.fail("tangential_damping_ratio", "needs friction");
    return;
  }
  Friction& friction = parameters.friction;
  friction = {.friction = table.real("friction"), .damping_ratio = table.real("tangential_damping_ratio")};
  if (law.effective_modulus > 0) {
    if (table.has("tangential_stiffness"))
      table.fail("tangential_stiffness",
                 "must be left out for Hertz's law: Mindlin's follows from the moduli");
    friction.shear_modulus = shear_modulus(*pair.materials[0], *pair.materials[1]);
  } else if (table.has("tangential_stiffness")) {
    friction.stiffness = table.real("tangential_stiffness");
  } else if (law.exponent == 1) {
    friction.stiffness = standard_slip_stiffness(law.normal_stiffness);
  } else {
    table.fail("tangential_stiffness", "missing; it follows from the stiffness only where exponent = 1");
  }
}

}  // namespace

PairLaw pair_law_list::friction() { return {keys, take}; }

}  // namespace scree
