// Hertz's law from a deck: moduli of the materials, restitutions of their pairs, and refusals.
#include <cmath>

#include "model/checks/limits.hpp"
#include "physics/restitution.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/restitution.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;

const std::string kSpace = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
end = 1.0
step = 1e-5
control = "fixed"
)";
const std::string kSteel = R"(
[[materials]]
name = "steel"
young_modulus = 2e11
poisson_ratio = 0.3
)";
const std::string kRubber = R"(
[[materials]]
name = "rubber"
young_modulus = 1e7
poisson_ratio = 0.5
)";
const std::string kGrains = R"(
[[particles]]
name = "small"
kind = "list"
positions = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]
radius = 0.02
mass = 0.1
material = "steel"
)";
const std::string kLarge = R"(
[[particles]]
name = "large"
kind = "list"
positions = [[0.0, 0.5, 0.0]]
radius = 0.08
mass = 2.0
material = "rubber"
)";

std::string pair_of(const std::string& a, const std::string& b, const std::string& keys) {
  return "[[contact.pairs]]\nmaterials = [\"" + a + "\", \"" + b + "\"]\n" + keys;
}
std::string steel_pair(const std::string& keys) { return pair_of("steel", "steel", keys); }

std::string error_of(const std::string& text) { return model_error(kSpace + text); }

}  // namespace

TEST_CASE("a pair without a stiffness follows Hertz's law from the moduli of its materials") {
  const Model model =
      model_of(kSpace + kSteel + kRubber + kGrains + kLarge + steel_pair("restitution = 0.9\n") +
               pair_of("rubber", "steel", "restitution = 0.5\nlimit_damping = false\n") +
               pair_of("rubber", "rubber", "stiffness = 0.0\n"));
  const NormalLawParameters &steel = model.contact.law(0, 0), &mixed = model.contact.law(0, 1);
  CHECK(near(steel.effective_modulus, 2e11 / (2 * 0.91), {.relative = kRoundOff}));
  CHECK(near(mixed.effective_modulus, 1 / (0.91 / 2e11 + 0.75 / 1e7), {.relative = kRoundOff}));
  CHECK(model.contact.law(1, 0).effective_modulus == mixed.effective_modulus);
  CHECK(near(restitution_of(steel.damping_ratio, false), 0.9, {.relative = kRoundOff}));
  CHECK(near(restitution_of(mixed.damping_ratio, true), 0.5, {.relative = kRoundOff}));
  CHECK((mixed.tension && !steel.tension && steel.normal_stiffness == 0));
  CHECK((!model.contact.law(1, 1).acts() && steel.acts()));
  CHECK(model_of(kSpace + kSteel + kGrains + steel_pair("")).contact.law(0, 0).damping_ratio == 0);
}

TEST_CASE(
    "contact times and step limits under Hertz's law are those of the smallest partners at 1 % overlap") {
  const Model model = model_of(kSpace + kSteel + kRubber + kGrains + kLarge + steel_pair("") +
                               pair_of("rubber", "steel", "") + pair_of("rubber", "rubber", ""));
  const std::vector<PairLimit> limits = pair_limits(model);
  REQUIRE(limits.size() == 2);  // a single large one has no partner of its kind
  const Real modulus[] = {model.contact.law(0, 0).effective_modulus,
                          model.contact.law(0, 1).effective_modulus};
  const Real radius[] = {0.01, 0.016}, mass[] = {0.05, 0.2 / 2.1};  // R*, m*
  for (std::size_t k = 0; k < 2; ++k) {
    CAPTURE(k);
    const Real slope = 2 * modulus[k] * std::sqrt(radius[k] * 0.01 * 0.02);
    CHECK(near(limits[k].stiffness, slope, {.relative = kRoundOff}));
    CHECK(near(limits[k].contact_time, 3.14159265358979324 * std::sqrt(mass[k] / slope),
               {.relative = kRoundOff}));
  }
  CHECK(near(limits[0].explicit_step, 2 / std::sqrt(8 * limits[0].stiffness / 0.1), {.relative = kRoundOff}));
  // Damping shortens the step.
  CHECK(
      pair_limits(model_of(kSpace + kSteel + kGrains + steel_pair("restitution = 0.3\n")))[0].explicit_step <
      0.7 * limits[0].explicit_step);
}

TEST_CASE("a restitution below that of critical damping is no slip") {
  CHECK(model_warnings(kSpace + kSteel + kGrains + steel_pair("restitution = 0.05\n"), {"time.step=1e-7"})
            .empty());
}

TEST_CASE("errors of Hertz's law in a deck are refused with a remedy") {
  const std::string deck = kSteel + kGrains;
  CHECK(contains(
      error_of(kSteel + "[[materials]]\nname = \"clay\"\n" + kGrains +
               pair_of("steel", "clay", "restitution = 0.5\n")),
      "deck.toml:25:1: contact.pairs.0.stiffness: missing; give it or, for Hertz's law, young_modulus and "
      "poisson_ratio of both materials: \"clay\" has none"));
  CHECK(contains(model_error(kSmallDeck + "[[contact.pairs]]\n"), "\"default\" has none"));
  CHECK(contains(error_of(deck + steel_pair("stiffness = 1e6\n")),
                 "contact.pairs.0.stiffness = 1e6: both materials have a young_modulus, too; leave out the "
                 "stiffness for Hertz's law, or the moduli for this one"));
  CHECK(contains(
      error_of("[[materials]]\nname = \"steel\"\nyoung_modulus = 1e9\n" + kGrains + steel_pair("")),
      "materials.steel.poisson_ratio: missing; Hertz's law takes young_modulus and poisson_ratio together"));
  CHECK(contains(error_of("[[materials]]\nname = \"steel\"\npoisson_ratio = 0.2\n" + kGrains +
                          steel_pair("stiffness = 1e6\n")),
                 "materials.steel.young_modulus: missing"));
  CHECK(
      contains(error_of(deck + steel_pair("damping = 3.0\n")),
               "contact.pairs.0.damping = 3.0: must be left out for Hertz's law, whose damping follows from "
               "restitution"));
  CHECK(contains(error_of(deck + steel_pair("exponent = 1.5\n")),
                 "contact.pairs.0.exponent = 1.5: must be left out for Hertz's law"));
  for (const std::string value : {"0.0", "1.01", "-0.5"})
    CHECK(contains(error_of(deck + steel_pair("restitution = " + value + "\n")),
                   "must be a number above 0 and at most 1"));
}

TEST_CASE("moduli and Poisson's ratios out of their range are refused") {
  const auto error = [](const std::string& young, const std::string& poisson) {
    return error_of("[[materials]]\nname = \"steel\"\nyoung_modulus = " + young +
                    "\npoisson_ratio = " + poisson + "\n" + kGrains + steel_pair(""));
  };
  CHECK(error("1e7", "0.5").empty());
  CHECK(error("1e7", "-0.99").empty());
  for (const std::string poisson : {"0.51", "-1.0", "-2.0"})
    CHECK(contains(error("1e7", poisson), "must be a number above -1 and at most 0.5"));
  for (const std::string young : {"0.0", "-1e7"})
    CHECK(contains(error(young, "0.3"), "must be a number above 0 [Pa]"));
}

TEST_CASE("Hertz's law is refused beside pairs with a stiffness") {
  const std::string clay = "[[materials]]\nname = \"clay\"\n";
  CHECK(contains(
      error_of(kSteel + clay + kGrains + steel_pair("") + pair_of("steel", "clay", "stiffness = 1e5\n")),
      "contact.pairs.1.stiffness = 1e5: given, while a pair before has none; a deck follows Hertz's "
      "law for all pairs"));
  CHECK(contains(
      error_of(kSteel + clay + kGrains + pair_of("steel", "clay", "stiffness = 1e5\n") + steel_pair("")),
      "contact.pairs.1.stiffness: missing, while a pair before has one"));
  CHECK(error_of(kSteel + clay + kGrains + pair_of("steel", "clay", "stiffness = 0.0\n") + steel_pair(""))
            .empty());
}

}  // namespace scree
