// Keys of liquid bridges: the resulting laws, the search range, mixing, and refusals.
#include "physics/liquid_bridge.hpp"

#include <string>

#include "model/checks/explicit_step.hpp"
#include "model/checks/limits.hpp"
#include "physics/cohesion.hpp"
#include "physics/restitution.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/restitution.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;

std::string grains_in(int dimension) {
  const std::string third = dimension == 2 ? "" : ", 0.0";
  const auto corner = [&](const std::string& x) { return x + ", " + x + (dimension == 2 ? "" : ", " + x); };
  return "[space]\ndimension = " + std::to_string(dimension) + "\nmin = [" + corner("-1.0") + "]\nmax = [" +
         corner("1.0") +
         "]\n[time]\nend = 1.0\nstep = 1e-7\n[integrator]\nparticles = \"velocity-verlet\"\n[[particles]]\n"
         "name = \"grains\"\nkind = \"list\"\npositions = [[0.0, 0.0" +
         third + "], [0.5, 0.0" + third + "]]\nradius = 0.001\nmass = 1e-5\nmaterial = \"sand\"\n";
}
const std::string kHertz = "[[materials]]\nname = \"sand\"\nyoung_modulus = 1e7\npoisson_ratio = 0.3\n";
const std::string kBare = "[[materials]]\nname = \"sand\"\n";

std::string pair_of(const std::string& keys) {
  return "[[contact.pairs]]\nmaterials = [\"sand\", \"sand\"]\n" + keys;
}
std::string hertz(const std::string& keys) { return kHertz + grains_in(3) + pair_of(keys); }
std::string linear(const std::string& keys, int dimension = 3) {
  return kBare + grains_in(dimension) + pair_of("stiffness = 1e4\n" + keys);
}
const std::string kWater = "bridge_volume = 1e-3\nsurface_tension = 0.0728\n";

}  // namespace

TEST_CASE("the keys of liquid bridges are the pair's, beside a linear law and Hertz's") {
  const Model water = model_of(linear(kWater + "restitution = 0.6\n"));
  const NormalLawParameters& law = water.contact.law(0, 0);
  REQUIRE(law.own.as<BridgeParameters>());
  const LiquidBridge& liquid = law.own.as<BridgeParameters>()->liquid;
  CHECK((liquid.volume == 1e-3 && liquid.surface_tension == 0.0728));
  CHECK((liquid.contact_angle == 0 && liquid.viscosity == 0 && !liquid.soulie));
  CHECK(near(restitution_of(law.damping_ratio, true), 0.6, {.relative = kRoundOff}));
  CHECK(water.rotates());  // the contact rotates with its partners
  CHECK(water.is_cohesive());
  CHECK(near(water.contact.interaction_range, 1e-4, {.relative = 1e-8}));
  const LiquidBridge oil =
      model_of(hertz(kWater + "contact_angle = 0.3\nbridge_force = \"soulie\"\nbridge_viscosity = 0.1\n"))
          .contact.law(0, 0)
          .own.value<BridgeParameters>()
          .liquid;
  CHECK((oil.contact_angle == 0.3 && oil.viscosity == 0.1 && oil.least_gap == 0.01 && oil.soulie));
  for (const std::string dry : {"bridge_volume = 0.0\n", "bridge_volume = 0.0\nsurface_tension = 0.07\n",
                                "bridge_volume = 1e-3\nsurface_tension = 0.0\n"}) {
    const Model model = model_of(linear(dry));
    CHECK((!model.is_cohesive() && !model.rotates() && model.contact.interaction_range == 0));
  }
}

TEST_CASE("sticking speed of the smallest partners; the chosen step resolves it") {
  const PairLimit water = pair_limits(model_of(linear(kWater)))[0];
  CHECK(near(water.sticking_speed, std::sqrt(2 * 1.02536867e-8 / 5e-6), {.relative = 1e-8}));
  CHECK(near(water.longest_step, 0.05 * std::sqrt(1e-9) / water.sticking_speed, {.relative = 1e-12}));
  CHECK(pair_limits(model_of(linear("")))[0].sticking_speed == 0);
  // Viscosity shortens the stable step.
  CHECK(pair_limits(model_of(linear(kWater + "bridge_viscosity = 1.0\n")))[0].explicit_step <
        0.5 * pair_limits(model_of(linear(kWater)))[0].explicit_step);
  // Grains so soft that the bridge alone is the bound.
  const ExplicitStep soft = longest_explicit_step(model_of(
      kBare + grains_in(3) + pair_of("stiffness = 0.1\nsurface_tension = 50.0\nbridge_volume = 1e-3\n")));
  CHECK(contains(soft.reason, "of the time in which liquid bridges of \"sand\" on \"sand\" stretch"));
}

TEST_CASE("liquid bridges of combined pairs") {
  const std::string materials = kBare + "[[materials]]\nname = \"steel\"\n";
  const std::string wall =
      "[[walls]]\nname = \"floor\"\npoint = [0.0, 0.0, -0.5]\nnormal = [0.0, 0.0, 1.0]\n"
      "material = \"steel\"\n";
  const auto deck = [&](const std::string& other) {
    return materials + grains_in(3) + wall + "[contact]\nmixing = \"geometric\"\n" +
           pair_of("stiffness = 1e4\ncontact_angle = 0.1\n" + kWater) +
           "[[contact.pairs]]\nmaterials = [\"steel\", \"steel\"]\nstiffness = 1e4\n" + other;
  };
  const LiquidBridge mixed =
      model_of(deck("bridge_volume = 4e-3\nsurface_tension = 0.0728\ncontact_angle = 0.4\n"))
          .contact.law(0, 1)
          .own.value<BridgeParameters>()
          .liquid;
  CHECK(near(mixed.volume, 2e-3, {.relative = kRoundOff}));
  CHECK(near(mixed.contact_angle, 0.2, {.relative = kRoundOff}));
  CHECK(mixed.surface_tension == 0.0728);
  CHECK(contains(model_error(deck("bridge_volume = 1e-3\nsurface_tension = 0.03\ncontact_angle = 0.4\n")),
                 "surface_tension = 0.03: differs from the 0.0728"));
  CHECK(contains(model_error(deck("")), "bridge_volume"));
}

TEST_CASE("unsupported liquid bridges are refused with a remedy") {
  for (const std::string key : {"surface_tension = 0.07", "contact_angle = 0.1", "bridge_force = \"soulie\"",
                                "bridge_viscosity = 0.1", "bridge_least_gap = 0.1"})
    CHECK(contains(model_error(linear(key + "\n")), "contact.pairs.0." + key + ": needs bridge_volume"));
  CHECK(contains(model_error(linear("bridge_volume = 1e-3\n")),
                 "contact.pairs.0.surface_tension: missing; it must stand beside bridge_volume"));
  CHECK(contains(model_error(linear(kWater + "bridge_least_gap = 0.1\n")),
                 "bridge_least_gap = 0.1: needs bridge_viscosity"));
  CHECK(
      contains(model_error(linear("bridge_volume = 0.2\nsurface_tension = 0.07\n")), "bridge_volume = 0.2"));
  CHECK(contains(model_error(linear(kWater, 2)), "bridge_volume = 1e-3: must be left out in 2D"));
  CHECK(contains(model_error(linear(kWater + "exponent = 1.5\n")),
                 "bridge_volume = 1e-3: needs a pair with exponent = 1, or Hertz's law"));
  CHECK(contains(model_error(kBare + grains_in(3) + pair_of("stiffness = 0.0\n" + kWater)),
                 "bridge_volume = 1e-3: must be left out where the stiffness is 0"));
  const std::string kinds =
      "in a deck with liquid bridges no pair has adhesion, an attraction or a plasticity_ratio";
  for (const std::string other :
       {"work_of_adhesion = 0.1\n", "work_of_adhesion = 0.1\nadhesion = \"dmt\"\n", "attraction = 0.1\n"})
    CHECK(contains(model_error(hertz(kWater + other)), kinds));
  CHECK(contains(model_error(linear(kWater), {"integrator.particles=hht"}),
                 "needs integrator.particles = \"velocity-verlet\""));
  CHECK(model_of(linear(kWater), {"integrator.precision=mixed"}).is_cohesive());
}

}  // namespace scree
