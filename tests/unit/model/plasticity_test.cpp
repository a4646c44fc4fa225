// Keys of plastic contacts: the resulting laws, estimates of steps, and refusals.
#include <string>

#include "model/checks/limits.hpp"
#include "model/derived/choose_law.hpp"
#include "physics/restitution.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kGrains = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
end = 1.0
step = 1e-7
[integrator]
particles = "velocity-verlet"
[[particles]]
name = "grains"
kind = "list"
positions = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]
radius = 0.02
mass = 0.1
material = "soil"
)";
const std::string kModuli = "young_modulus = 1e7\npoisson_ratio = 0.3\n";

std::string deck_of(const std::string& materials, const std::string& pairs) {
  return materials + kGrains + pairs;
}
std::string pair_of(const std::string& a, const std::string& b, const std::string& keys) {
  return "[[contact.pairs]]\nmaterials = [\"" + a + "\", \"" + b + "\"]\n" + keys;
}
std::string hertz(const std::string& keys) {
  return deck_of("[[materials]]\nname = \"soil\"\n" + kModuli, pair_of("soil", "soil", keys));
}
std::string linear(const std::string& keys) {
  return deck_of("[[materials]]\nname = \"soil\"\n", pair_of("soil", "soil", "stiffness = 1e5\n" + keys));
}
// Soil on soil, soil on steel, steel on steel.
std::string beside_steel(const std::string& soil, const std::string& both) {
  return deck_of(
      "[[materials]]\nname = \"soil\"\n" + kModuli + "[[materials]]\nname = \"steel\"\n" + kModuli,
      pair_of("soil", "soil", soil) + pair_of("soil", "steel", both) + pair_of("steel", "steel", ""));
}

}  // namespace

TEST_CASE("plastic pairs have the law of their loading curve, with friction") {
  const Model soil = model_of(hertz("plasticity_ratio = 0.6\nwork_of_adhesion = 20.0\nattraction = 1e-3\n"));
  const NormalLawParameters& law = soil.contact.law(0, 0);
  REQUIRE(law.own.as<Plasticity>());
  CHECK((law.own.as<Plasticity>()->ratio == 0.6 && law.adhesion_work == 20 && law.attraction == 1e-3 &&
         !law.jkr));
  CHECK(law.own.as<Plasticity>()->adhesion_exponent == 1.5);
  CHECK((soil.rotates() && soil.is_cohesive() && soil.contact.interaction_range == 0));
  CHECK(history_of(soil.contact) == 8);
  with_contact_laws(soil.contact, []<class Law>(const std::vector<Law>&) {
    CHECK(std::is_same_v<typename Law::Normal, EepaLaw<HertzLaw>>);
  });
  const Model balls = model_of(linear("plasticity_ratio = 0.6\nadhesion_exponent = 3.5\n"));
  CHECK(balls.contact.law(0, 0).own.value<Plasticity>().adhesion_exponent == 3.5);
  with_contact_laws(balls.contact, []<class Law>(const std::vector<Law>&) {
    CHECK(std::is_same_v<typename Law::Normal, EepaLaw<LinearRestitutionLaw>>);
  });
  // The damper is that of a force that may be tensile; 0 is the same as leaving the key out.
  const Real damped =
      model_of(linear("plasticity_ratio = 0.6\nrestitution = 0.7\n")).contact.law(0, 0).damping_ratio;
  CHECK(damped == damping_ratio_of(0.7, true));
  for (const std::string exponent : {"", "adhesion_exponent = 2.0\n"})
    CHECK_FALSE(model_of(linear("plasticity_ratio = 0.0\n" + exponent)).contact.law(0, 0).own);
}

TEST_CASE("the step of plastic pairs follows from the stiffness of unloading") {
  const PairLimit elastic = pair_limits(model_of(linear("friction = 0.0\n")))[0],
                  plastic = pair_limits(model_of(linear("friction = 0.0\nplasticity_ratio = 0.59\n")))[0];
  CHECK(near(plastic.stiffness, elastic.stiffness / 0.41, {.relative = 1e-14}));
  CHECK(near(plastic.explicit_step, elastic.explicit_step * std::sqrt(0.41), {.relative = 1e-12}));
}

TEST_CASE("pairs without plasticity may stand beside plastic ones") {
  const Model model = model_of(beside_steel("plasticity_ratio = 0.6\nwork_of_adhesion = 20.0\n",
                                            "friction = 0.3\nattraction = 1e-3\n"));
  CHECK(!model.contact.law(0, 1).own.as<Plasticity>());
  CHECK(history_of(model.contact) == 8);
}

TEST_CASE("incompatible keys beside a plasticity ratio are refused with a remedy") {
  const std::string plastic = "plasticity_ratio = 0.6\n";
  CHECK(contains(model_error(linear("adhesion_exponent = 2.0\n")),
                 "adhesion_exponent = 2.0: needs plasticity_ratio"));
  CHECK(contains(model_error(linear("exponent = 1.5\n" + plastic)),
                 "plasticity_ratio = 0.6: needs a pair with exponent = 1, or Hertz's law"));
  CHECK(contains(model_error(hertz(plastic + "surface_energy = 5.0\n")),
                 "surface_energy = 5.0: must be left out beside plasticity_ratio: give work_of_adhesion"));
  CHECK(contains(model_error(hertz(plastic + "work_of_adhesion = 5.0\nadhesion = \"jkr\"\n")),
                 "adhesion = \"jkr\": must be left out beside plasticity_ratio"));
  CHECK(contains(model_error(linear(plastic + "attraction = 1.0\nattraction_range = 1e-6\n")),
                 "attraction_range = 1e-6: must be left out beside plasticity_ratio"));
  for (const std::string exponent : {"1.0", "1.6"})
    CHECK(contains(model_error(hertz(plastic + "adhesion_exponent = " + exponent + "\n")),
                   "adhesion_exponent = " + exponent + ": must be a multiple of 0.5 from 1.5"));
  CHECK(contains(model_error(linear("plasticity_ratio = 1.0\n")), "plasticity_ratio = 1.0: must be"));
  CHECK(contains(model_error(linear(plastic), {"integrator.particles=hht"}),
                 "plasticity_ratio = 0.6: needs integrator.particles = \"velocity-verlet\""));
  CHECK(contains(model_error(beside_steel(plastic, "work_of_adhesion = 0.1\n")),
                 "work_of_adhesion = 0.1: in a deck with a plasticity_ratio, all pairs with a work of "
                 "adhesion have one"));
  CHECK(contains(model_error(beside_steel("work_of_adhesion = 0.1\nadhesion = \"dmt\"\n", plastic)),
                 "plasticity_ratio = 0.6: in a deck with a plasticity_ratio, all pairs with a work of "
                 "adhesion have one"));
}

}  // namespace scree
