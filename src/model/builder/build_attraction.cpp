#include "model/builder/build_normal_law.hpp"
#include "physics/restitution.hpp"

namespace scree {

void take_attraction(const DeckTable& table, NormalLawParameters& law) {
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
