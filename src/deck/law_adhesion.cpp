// Adhesion, attraction and plasticity of a pair of materials.
#include <fmt/format.h>

#include <cmath>

#include "deck/choices.hpp"
#include "deck/pair_laws.hpp"
#include "physics/eepa.hpp"

namespace scree {

namespace {

std::vector<Key> keys() {
  return {
      real("work_of_adhesion", "J/m^2")
          .at_least(0)
          .left_out("no adhesion")
          .combined(Combining::other)
          .about("w, for Hertz's law: energy per area to separate the two surfaces. The normal force "
                 "may then be tensile with either value of limit_damping, and the friction limit "
                 "includes the adhesive force. JKR and plastic contacts need explicit steps; with any "
                 "adhesion the run is in double precision. Adhesion acts on particles and on the discs "
                 "and spheres on bodies, not on the corners of a body's mesh on a plane."),
      real("surface_energy", "J/m^2")
          .at_least(0)
          .left_out("work_of_adhesion is given, or no adhesion")
          .combined(Combining::other)
          .about("In place of work_of_adhesion: w/2, of each of two equal surfaces."),
      choice<Adhesion>("adhesion")
          .left_out("jkr")
          .combined(Combining::other)
          .about("With work_of_adhesion. jkr: the contact forms at touch, persists under tension and breaks "
                 "at the pull-off force 3/2 pi w R* (Johnson, Kendall, Roberts, 1971; soft, sticky, large). "
                 "dmt: a constant adhesive force 2 pi w R* while the surfaces touch (Derjaguin, Muller, "
                 "Toporov, 1975; hard, small). All pairs of a deck have the same model."),
      real("attraction", "N")
          .at_least(0)
          .left_out("none")
          .combined(Combining::mean)
          .about("A constant attractive force in addition to a linear or Hertz's law, while the two touch."),
      real("attraction_range", "m")
          .above(0)
          .left_out("the attraction ends where the contact opens")
          .combined(Combining::mean)
          .about("Distance between the surfaces over which the attraction falls linearly to zero. Explicit "
                 "steps only."),
      real("plasticity_ratio", "")
          .within(0, 0.999)
          .left_out("the contact is elastic, as with 0")
          .combined(Combining::mean)
          .about("l = 1 - k1/k2: plastic contacts by the Edinburgh elasto-plastic adhesion model "
                 "(EEPA), k1: stiffness of loading, K or Hertz's, k2: stiffness of unloading. The "
                 "pull-off force is 3/2 pi g a, and at most k2 d_p^n / 2; g: work_of_adhesion (the "
                 "surface energy of other programs), d_p: plastic overlap, a = sqrt(2 R* d_p - d_p^2): "
                 "contact radius, R*: reduced radius, n: exponent of the stiffness. A constant "
                 "attraction may be added. restitution is that of the damper alone: without adhesion "
                 "and damping, a linear contact has the restitution sqrt(1 - l). Plastic contacts need "
                 "explicit steps, and the run is in double precision. Pairs without plasticity_ratio, "
                 "or with 0, may then have an attraction, but no other adhesion."),
      real("adhesion_exponent", "")
          .within(1, 5)
          .left_out("the exponent of the stiffness: 1, or 1.5 with Hertz's law")
          .combined(Combining::same)
          .about("chi, with plasticity_ratio: after the pull-off force the adhesive force decreases "
                 "with the overlap d as d^chi. It is a multiple of 0.5, and at least the exponent of "
                 "the stiffness.")};
}

// Elasto-plastic adhesion (physics/eepa.hpp), all but the attraction.
void take_plasticity(const DeckTable& table, NormalLawParameters& law) {
  const char* key = "plasticity_ratio";
  if (!law.acts()) table.fail(key, "must be left out where the stiffness is 0");
  if (law.effective_modulus == 0 && law.exponent != 1)
    table.fail(key, "needs a pair with exponent = 1, or Hertz's law");
  const std::string out = "must be left out beside plasticity_ratio";
  if (table.has("surface_energy"))
    table.fail("surface_energy", out +
                                     ": give work_of_adhesion, the g of the pull-off force 3/2 pi g a, "
                                     "which other programs call surface energy");
  if (table.has("adhesion"))
    table.fail("adhesion", out + ": plastic contacts are neither JKR nor DMT contacts");
  if (table.has("attraction_range"))
    table.fail("attraction_range", out + ": plastic contacts have no range beyond touch");
  if (table.has("work_of_adhesion")) law.adhesion_work = table.real("work_of_adhesion");
  const Real least = law.effective_modulus > 0 ? Real(1.5) : 1;
  const Real exponent = table.has("adhesion_exponent") ? table.real("adhesion_exponent") : least;
  if (exponent < least || std::fmod(2 * exponent, 1) != 0)
    table.fail(
        "adhesion_exponent",
        fmt::format("must be a multiple of 0.5 from {:g}, the exponent of the stiffness, to 5", least));
  law.own = Plasticity(table.real(key), exponent);
}

// Adhesion of an elastic pair.
void take_adhesion(const DeckTable& table, NormalLawParameters& law) {
  if (table.has("adhesion_exponent") && !table.has("plasticity_ratio"))
    table.fail("adhesion_exponent", "needs plasticity_ratio");
  if (table.has("surface_energy") && table.has("work_of_adhesion"))
    table.fail("surface_energy", "stands beside work_of_adhesion; give one of the two");
  const char* key = table.has("surface_energy") ? "surface_energy" : "work_of_adhesion";
  if (is_positive(table, key)) {
    if (law.effective_modulus == 0)
      table.fail(key,
                 "needs Hertz's law: young_modulus and poisson_ratio of both materials, spheres, and no "
                 "stiffness; other laws may have an attraction");
    law.adhesion_work = (table.has("surface_energy") ? 2 : 1) * table.real(key);
    law.jkr = !table.has("adhesion") || table.choice<Adhesion>("adhesion") == Adhesion::jkr;
  } else if (table.has("adhesion") && !table.has(key)) {
    table.fail("adhesion", "needs work_of_adhesion or surface_energy");
  }
}

void take(const PairInDeck& pair, PairParameters& parameters) {
  const DeckTable& table = pair.table;
  NormalLawParameters& law = parameters.normal;
  if (is_positive(table, "plasticity_ratio"))
    take_plasticity(table, law);
  else
    take_adhesion(table, law);
  if (is_positive(table, "attraction")) {
    if (law.effective_modulus == 0 && law.exponent != 1)
      table.fail("attraction", "needs a pair with exponent = 1, or Hertz's law");
    if (!law.acts()) table.fail("attraction", "must be left out where the stiffness is 0");
    law.attraction = table.real("attraction");
  }
  if (table.has("attraction_range")) {
    if (!table.has("attraction")) table.fail("attraction_range", "needs attraction");
    law.range = law.attraction > 0 ? table.real("attraction_range") : 0;
  }
}

}  // namespace

PairLaw pair_law_list::adhesion() { return {keys, take}; }

}  // namespace scree
