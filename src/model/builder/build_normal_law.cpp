#include "model/builder/build_normal_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/checks/limits.hpp"
#include "model/checks/plausibility.hpp"
#include "physics/restitution.hpp"

namespace scree {

namespace {

// Sets the damping ratio for the restitution, which depends on the law's K, n and tension.
void take_restitution(const DeckTable& table, NormalLawParameters& law) {
  if (!table.has("restitution")) return;
  if (table.real("damping") > 0) table.fail("restitution", "stands beside a damping; give one of the two");
  if (!law.acts()) table.fail("restitution", "must be left out where the stiffness is 0");
  if (law.exponent < 1)
    table.fail("restitution", "needs an exponent of at least 1: below, its damper would have no bound");
  law.damping_ratio = damping_ratio_of(table.real("restitution"), law.tension);
}

// Stiffness K for which an undamped head-on impact at the given speed reaches the given overlap: K d^(n+1) /
// (n+1) = m* v^2 / 2, with the largest reduced mass and the smallest radius of the pair's partners [N/m^n].
Real stiffness_of_overlap(const DeckTable& table, const Model& model, const int (&material)[2]) {
  if (table.has("stiffness")) table.fail("largest_overlap", "stands beside a stiffness; give one of the two");
  if (table.real("damping") > 0)
    table.fail("damping", "must be left out beside largest_overlap; give a restitution instead");
  if (!table.has("impact_speed"))
    table.fail("impact_speed", "missing; largest_overlap is that of an impact at this speed");
  const std::vector<MaterialUse> uses = material_uses(model);
  const MaterialUse &a = uses[static_cast<std::size_t>(material[0])],
                    &b = uses[static_cast<std::size_t>(material[1])];
  if (a.particles + b.particles == 0)
    table.fail("largest_overlap", "needs particles of one of the two materials; give a stiffness");
  const bool alike = a.particles > 0 && b.particles > 0 && !a.is_of_surfaces() && !b.is_of_surfaces();
  const Real mass = model.particles.totals.largest_mass / (alike ? 2 : 1);
  const PairSize smallest = smallest_partners(a, b);
  const Real overlap = table.real("largest_overlap") * std::min(smallest.radius_i, smallest.radius_j);
  const Real speed = table.real("impact_speed"), n = table.real("exponent");
  return (n + 1) / 2 * mass * speed * speed / std::pow(overlap, n + 1);
}

// F = K d^n + C d_dot, with K given or derived from a largest overlap.
NormalLawParameters stiffness_law(const DeckTable& table, const Model& model, const int (&material)[2],
                                  bool has_moduli) {
  const bool from_overlap = table.has("largest_overlap");
  NormalLawParameters law{
      from_overlap ? stiffness_of_overlap(table, model, material) : table.real("stiffness"),
      table.real("damping"), table.real("exponent"), !table.boolean("limit_damping")};
  const char* key = from_overlap ? "largest_overlap" : "stiffness";
  if (law.normal_stiffness != 0) check_normal(table, key, law.normal_stiffness);
  if (law.normal_stiffness == 0 && law.normal_damping > 0)
    table.fail("damping", "must be 0 where the stiffness is 0");
  take_restitution(table, law);
  if (law.acts() && has_moduli)
    table.fail(key, fmt::format("both materials have a young_modulus, too; leave out the {} for Hertz's law, "
                                "or the moduli for this one",
                                key));
  return law;
}

// Young's modulus over 1 - nu^2 [Pa], or 0 where the material has none.
Real plane_strain_modulus(const DeckTable& material) {
  if (!material.has("young_modulus")) return 0;
  const Real ratio = material.real("poisson_ratio");
  return material.real("young_modulus") / (1 - ratio * ratio);
}

// Hertz's law; moduli: of the two materials.
NormalLawParameters hertz_law(const DeckTable& table, const Model& model, const Real (&moduli)[2],
                              const int (&material)[2]) {
  for (int side = 0; side < 2; ++side)
    if (moduli[side] == 0)
      table.fail("stiffness",
                 fmt::format("missing; give it or, for Hertz's law, young_modulus and poisson_ratio of both "
                             "materials: \"{}\" has none",
                             model.contact.material_names[static_cast<std::size_t>(material[side])]));
  if (table.real("damping") > 0)
    table.fail("damping", "must be left out for Hertz's law, whose damping follows from restitution");
  if (table.real("exponent") != 1)
    table.fail("exponent", "must be left out for Hertz's law, which has its own");
  NormalLawParameters law;
  law.tension = !table.boolean("limit_damping");
  law.effective_modulus = 1 / (1 / moduli[0] + 1 / moduli[1]);
  take_restitution(table, law);
  return law;
}

// Discs in line contact: F = pi/4 E* L d, L: thickness (V. L. Popov, Contact Mechanics and Friction, 2010,
// section 5.2, without the logarithm of the exact law), in place of Hertz's law of spheres.
NormalLawParameters line_contact(const DeckTable& table, const Model& model, NormalLawParameters law) {
  const DiscThickness& discs = model.disc_thickness;
  if (discs.smallest != discs.largest || discs.largest == 0)
    table.fail("stiffness",
               fmt::format("missing; from moduli it follows for discs of one thickness, and {}",
                           discs.largest == 0 ? "here all masses are given" : "here there are several"));
  law.normal_stiffness = std::numbers::pi_v<Real> / 4 * law.effective_modulus * discs.largest;
  law.effective_modulus = 0;
  return law;
}

}  // namespace

void check_moduli(const DeckTable& material) {
  const bool has_modulus = material.has("young_modulus"), has_ratio = material.has("poisson_ratio");
  if (has_modulus != has_ratio)
    material.fail(has_modulus ? "poisson_ratio" : "young_modulus",
                  "missing; Hertz's law takes young_modulus and poisson_ratio together");
}

NormalLawParameters build_law(const DeckTable& deck, const DeckTable& table, const Model& model,
                              const int (&material)[2]) {
  const std::vector<DeckTable>& materials = deck.tables("materials");
  Real moduli[2] = {0, 0};
  for (std::size_t side = 0; side < 2 && !materials.empty(); ++side)
    moduli[side] = plane_strain_modulus(materials[static_cast<std::size_t>(material[side])]);
  if (!table.has("largest_overlap") && table.has("impact_speed"))
    table.fail("impact_speed", "needs largest_overlap");
  if (table.has("stiffness") || table.has("largest_overlap"))
    return stiffness_law(table, model, material, moduli[0] > 0 && moduli[1] > 0);
  const NormalLawParameters hertz = hertz_law(table, model, moduli, material);
  return model.space.dimension == 2 ? line_contact(table, model, hertz) : hertz;
}

}  // namespace scree
