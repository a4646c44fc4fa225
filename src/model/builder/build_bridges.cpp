// Liquid bridges of a pair of materials.
#include <array>

#include "model/builder/build_normal_law.hpp"

namespace scree {

namespace {

constexpr std::array kLiquidKeys{"surface_tension", "contact_angle", "bridge_force", "bridge_viscosity",
                                 "bridge_least_gap"};
constexpr Real kLeastGap = 0.01;

Real real_or(const DeckTable& pair, const char* key, Real standard) {
  return pair.has(key) ? pair.real(key) : standard;
}

}  // namespace

void take_bridges(const DeckTable& table, int dimension, NormalLawParameters& law) {
  if (!table.has("bridge_volume")) {
    for (const char* key : kLiquidKeys)
      if (table.has(key)) table.fail(key, "needs bridge_volume");
    return;
  }
  if (!table.has("surface_tension"))
    table.fail("surface_tension", "missing; it must stand beside bridge_volume");
  const LiquidBridge liquid{.volume = table.real("bridge_volume"),
                            .surface_tension = table.real("surface_tension"),
                            .contact_angle = real_or(table, "contact_angle", 0),
                            .viscosity = real_or(table, "bridge_viscosity", 0),
                            .least_gap = real_or(table, "bridge_least_gap", kLeastGap),
                            .soulie = table.has("bridge_force") &&
                                      table.choice<BridgeForce>("bridge_force") == BridgeForce::soulie};
  if (!(liquid.viscosity > 0) && table.has("bridge_least_gap"))
    table.fail("bridge_least_gap", "needs bridge_viscosity");
  if (!liquid.acts()) return;
  if (dimension == 2) table.fail("bridge_volume", "must be left out in 2D: the bridges are those of spheres");
  if (!law.acts()) table.fail("bridge_volume", "must be left out where the stiffness is 0");
  if (law.effective_modulus == 0 && law.exponent != 1)
    table.fail("bridge_volume", "needs a pair with exponent = 1, or Hertz's law");
  law.bridge = liquid;
}

}  // namespace scree
