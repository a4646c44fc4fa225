// Liquid bridges of a pair of materials.
#include <array>

#include "deck/pair_laws.hpp"
#include "physics/liquid_bridge.hpp"

namespace scree {

// Force of liquid bridges over the gap.
enum class BridgeForce { willett, soulie };
template <>
inline constexpr auto kWords<BridgeForce> =
    std::to_array<Word<BridgeForce>>({{"willett", BridgeForce::willett}, {"soulie", BridgeForce::soulie}});

namespace {

std::vector<Key> keys() {
  return {
      real("bridge_volume", "")
          .within(0, 0.1)
          .left_out("no liquid bridges")
          .combined(Combining::mean)
          .about("Volume V of each liquid bridge over the cube of the smaller radius; it is constant. A "
                 "bridge forms when the surfaces touch. Its attraction is constant while they do, "
                 "decreases over the gap that opens (bridge_force), and ends at the gap (1 + theta/2) "
                 "V^(1/3), where the bridge breaks. Bridges are added to a linear or Hertz's law. They "
                 "need explicit steps, and the run is in double precision. 0: no bridges."),
      real("surface_tension", "N/m")
          .at_least(0)
          .left_out("no liquid bridges")
          .combined(Combining::same)
          .about("gamma of the liquid: 0.0728 N/m for water in air at 20 C. Required with bridge_volume."),
      real("contact_angle", "rad")
          .within(0, 1.5)
          .left_out("0")
          .combined(Combining::mean)
          .about("theta, between the liquid and the surfaces; it is the same on both."),
      choice<BridgeForce>("bridge_force")
          .left_out("willett")
          .combined(Combining::same)
          .about("Force of a bridge at the gap S. willett: 2 pi R gamma cos(theta) / (1 + 1.05 s + 2.5 "
                 "s^2), s = S sqrt(R / V), R = 2 R* (Willett et al., 2000). soulie: an exponential "
                 "function that was fitted to spheres of unequal radii (Soulie et al., 2006); on walls "
                 "and meshes it is replaced by willett. While the surfaces touch, S is 0."),
      real("bridge_viscosity", "Pa s")
          .at_least(0)
          .left_out("no viscous force")
          .combined(Combining::same)
          .about("mu of the liquid: 1e-3 Pa s for water. While there is a bridge, a normal viscous "
                 "force 6 pi mu R* v / max(s_min, S/R*) is added to the damping of the contact; S: gap, "
                 "v: its rate, s_min: bridge_least_gap."),
      real("bridge_least_gap", "")
          .within(0, 1)
          .above(0)
          .left_out("0.01")
          .combined(Combining::same)
          .about("s_min: gap over R* below which the viscous force no longer grows, for example the "
                 "roughness of the surfaces over R*.")};
}

constexpr std::array kLiquidKeys{"surface_tension", "contact_angle", "bridge_force", "bridge_viscosity",
                                 "bridge_least_gap"};
constexpr Real kLeastGap = 0.01;

Real real_or(const DeckTable& pair, const char* key, Real standard) {
  return pair.has(key) ? pair.real(key) : standard;
}

void take(const PairInDeck& pair, PairParameters& parameters) {
  const DeckTable& table = pair.table;
  NormalLawParameters& law = parameters.normal;
  if (!table.has("bridge_volume")) {
    for (const char* key : kLiquidKeys)
      if (table.has(key)) table.fail(key, "needs bridge_volume");
    return;
  }
  if (!table.has("surface_tension")) {
    if (!is_positive(table, "bridge_volume")) return;
    table.fail("surface_tension", "missing; it must stand beside bridge_volume");
  }
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
  if (pair.dimension == 2)
    table.fail("bridge_volume", "must be left out in 2D: the bridges are those of spheres");
  if (!law.acts()) table.fail("bridge_volume", "must be left out where the stiffness is 0");
  if (law.effective_modulus == 0 && law.exponent != 1)
    table.fail("bridge_volume", "needs a pair with exponent = 1, or Hertz's law");
  if (law.own)
    table.fail("bridge_volume",
               "in a deck with liquid bridges no pair has adhesion, an attraction or a plasticity_ratio");
  law.own = BridgeParameters(liquid);
}

}  // namespace

PairLaw pair_law_list::liquid_bridges() { return {keys, take}; }

}  // namespace scree
