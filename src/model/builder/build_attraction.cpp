#include <fmt/format.h>

#include <cmath>

#include "model/builder/build_normal_law.hpp"
#include "physics/restitution.hpp"

namespace scree {

namespace {

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
  if (table.has("adhesion")) table.fail("adhesion", out + ", which has an adhesion of its own");
  if (table.has("attraction_range"))
    table.fail("attraction_range", out + ": its contacts end where the surfaces part");
  law.plasticity_ratio = table.real(key);
  if (table.has("work_of_adhesion")) law.adhesion_work = table.real("work_of_adhesion");
  const Real least = law.effective_modulus > 0 ? Real(1.5) : 1;
  law.adhesion_exponent = table.has("adhesion_exponent") ? table.real("adhesion_exponent") : least;
  if (law.adhesion_exponent < least || std::fmod(2 * law.adhesion_exponent, 1) != 0)
    table.fail(
        "adhesion_exponent",
        fmt::format("must be a multiple of 0.5 from {:g}, the exponent of the stiffness, to 5", least));
}

// Adhesion of an elastic pair.
void take_adhesion(const DeckTable& table, NormalLawParameters& law) {
  if (table.has("adhesion_exponent")) table.fail("adhesion_exponent", "needs plasticity_ratio");
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

}  // namespace

void take_attraction(const DeckTable& table, NormalLawParameters& law) {
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
  // The damping force of adhesive laws is not limited.
  if (law.is_cohesive() && table.has("restitution"))
    law.damping_ratio = damping_ratio_of(table.real("restitution"), true);
}

}  // namespace scree
