// Pairs of materials that the deck does not give: the rules, the result for every key, and refusals.
#include "model/builder/mixing.hpp"

#include <algorithm>
#include <cmath>

#include "physics/liquid_bridge.hpp"
#include "physics/restitution.hpp"
#include "physics/springs_in_series.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;

const std::string kMaterials = "[[materials]]\nname = \"a\"\n[[materials]]\nname = \"b\"\n";
const std::string kMetals =
    "[[materials]]\nname = \"a\"\nyoung_modulus = 2e8\npoisson_ratio = 0.3\n"
    "[[materials]]\nname = \"b\"\nyoung_modulus = 1e7\npoisson_ratio = 0.2\n";

std::string pair_of(const std::string& one, const std::string& other, const std::string& keys) {
  return "[[contact.pairs]]\nmaterials = [\"" + one + "\", \"" + other + "\"]\n" + keys;
}

// A sphere of each of the two materials.
std::string whole_deck(const std::string& materials, const std::string& contact, const std::string& pairs) {
  std::string text =
      "[space]\ndimension = 3\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\n[time]\nend = 1.0\n"
      "step = 1e-6\n[integrator]\nparticles = \"velocity-verlet\"\n[contact]\n" +
      contact + pairs + materials;
  for (const std::string name : {"a", "b"})
    text += "[[particles]]\nkind = \"list\"\npositions = [[" + std::string(name == "a" ? "0.0" : "0.5") +
            ", 0.0, 0.0]]\nradius = 0.02\nmass = 0.1\nmaterial = \"" + name + "\"\n";
  return text;
}
std::string deck_of(const std::string& rule, const std::string& of_a, const std::string& of_b,
                    const std::string& materials = kMaterials) {
  return whole_deck(materials, rule.empty() ? "" : "mixing = \"" + rule + "\"\n",
                    pair_of("a", "a", of_a) + pair_of("b", "b", of_b));
}

// All values of a derived pair and of one with given keys must agree.
void check_alike(const Model& made, const Model& given) {
  const NormalLawParameters &x = made.contact.law(0, 1), &y = given.contact.law(0, 1);
  CHECK((x.normal_stiffness == y.normal_stiffness && x.normal_damping == y.normal_damping));
  CHECK((x.exponent == y.exponent && x.tension == y.tension && x.damping_ratio == y.damping_ratio));
  CHECK((x.effective_modulus == y.effective_modulus && x.adhesion_work == y.adhesion_work));
  CHECK((x.jkr == y.jkr && x.attraction == y.attraction && x.range == y.range));
  const LiquidBridge p = x.own.value<BridgeParameters>().liquid, q = y.own.value<BridgeParameters>().liquid;
  CHECK((p.volume == q.volume && p.contact_angle == q.contact_angle));
  REQUIRE(made.contact.friction.size() == given.contact.friction.size());
  if (made.rotates()) {
    const Friction f = made.contact.friction_of(0, 1), g = given.contact.friction_of(0, 1);
    CHECK((f.friction == g.friction && f.stiffness == g.stiffness && f.shear_modulus == g.shear_modulus));
    CHECK(f.damping_ratio == g.damping_ratio);
  }
  const RollingParameters r = made.contact.rolling_of(0, 1), s = given.contact.rolling_of(0, 1);
  CHECK((r.friction == s.friction && r.stiffness == s.stiffness && r.damping == s.damping));
  CHECK((r.stiffness_factor == s.stiffness_factor && r.damping_ratio == s.damping_ratio));
  CHECK(r.twisting_friction == s.twisting_friction);
  const auto slot = static_cast<std::size_t>(made.contact.materials());
  CHECK(made.contact.wear.empty() == given.contact.wear.empty());
  if (!made.contact.wear.empty()) CHECK(made.contact.wear[slot] == given.contact.wear[slot]);
}

void check_becomes(const std::string& made, const std::string& of_a, const std::string& of_b,
                   const std::string& keys, const std::string& materials = kMaterials) {
  INFO(keys);
  const std::string likes = pair_of("a", "a", of_a) + pair_of("b", "b", of_b);
  const Model given = model_of(whole_deck(materials, "", likes + pair_of("b", "a", keys)));
  CHECK(given.contact.combined.empty());
  check_alike(model_of(deck_of(made, of_a, of_b, materials)), given);
}

}  // namespace

TEST_CASE("the rules of mixing") {
  CHECK(near(mixed(Mixing::geometric, 0.2, 0.8), 0.4, {.relative = kRoundOff}));
  CHECK(near(mixed(Mixing::arithmetic, 0.2, 0.8), 0.5, {.relative = kRoundOff}));
  CHECK(near(mixed(Mixing::harmonic, 0.2, 0.8), 0.32, {.relative = kRoundOff}));
  CHECK((mixed(Mixing::minimum, 0.2, 0.8) == 0.2 && mixed(Mixing::maximum, 0.2, 0.8) == 0.8));
  for (const Mixing rule :
       {Mixing::geometric, Mixing::arithmetic, Mixing::harmonic, Mixing::minimum, Mixing::maximum}) {
    CHECK(mixed(rule, 0.3, 0.7) == mixed(rule, 0.7, 0.3));
    CHECK((mixed(rule, 0.3, 0.3) == 0.3 && mixed(rule, 0, 0) == 0));
  }
  CHECK((mixed(Mixing::geometric, 0, 0.5) == 0 && mixed(Mixing::harmonic, 0.5, 0) == 0));
  // At equal force the overlap is the mean of those of the like pairs.
  for (const Real n : {1.0, 1.5, 2.0}) {
    const Real a = 3e5, b = 8e4, force = 7, k = in_series(a, b, n);
    const auto overlap = [&](Real stiffness) { return std::pow(force / stiffness, 1 / n); };
    CHECK(near(overlap(k), (overlap(a) + overlap(b)) / 2, {.relative = kRoundOff}));
    CHECK((in_series(b, a, n) == k && in_series(a, a, n) == a));
  }
}

TEST_CASE("a pair that is not given follows from the like ones, key by key") {
  const std::string soft = "stiffness = 1e5\n", hard = "stiffness = 3e5\n";
  // Springs in series: 2 * 1e5 * 3e5 / 4e5.
  const std::string both = "stiffness = 1.5e5\n";
  check_becomes("geometric", soft + "damping = 2.0\n", hard + "damping = 8.0\n", both + "damping = 4.0\n");
  check_becomes("arithmetic", soft + "damping = 2.0\n", hard, both + "damping = 1.0\n");
  check_becomes("arithmetic", soft + "restitution = 0.5\n", hard, both + "restitution = 0.75\n");
  check_becomes("minimum", soft + "restitution = 0.5\nlimit_damping = false\n",
                hard + "restitution = 0.75\nlimit_damping = false\n",
                both + "restitution = 0.5\nlimit_damping = false\n");
  check_becomes("maximum", "stiffness = 4e6\nexponent = 2.0\n", "stiffness = 4e6\nexponent = 2.0\n",
                "stiffness = 4e6\nexponent = 2.0\n");
  check_becomes("maximum", "largest_overlap = 0.02\nimpact_speed = 2.0\n",
                "largest_overlap = 0.02\nimpact_speed = 2.0\n",
                "largest_overlap = 0.02\nimpact_speed = 2.0\n");
  check_becomes("arithmetic", soft + "friction = 0.25\ntangential_damping_ratio = 0.5\n",
                hard + "friction = 0.75\n", both + "friction = 0.5\ntangential_damping_ratio = 0.25\n");
  // The default is 2/7 of 3.5e5.
  check_becomes("minimum", "stiffness = 3.5e5\nfriction = 0.25\ntangential_stiffness = 3e5\n",
                "stiffness = 3.5e5\nfriction = 0.25\n",
                "stiffness = 3.5e5\nfriction = 0.25\ntangential_stiffness = 1.5e5\n");
  check_becomes("harmonic",
                soft +
                    "friction = 0.5\nrolling_friction = 0.25\nrolling_damping_ratio = 0.5\n"
                    "rolling_stiffness = 0.25\nrolling_damping = 1e-3\n",
                hard +
                    "friction = 0.5\nrolling_friction = 0.75\nrolling_damping_ratio = 0.5\n"
                    "rolling_stiffness = 0.75\nrolling_damping = 1e-3\n",
                both +
                    "friction = 0.5\nrolling_friction = 0.375\nrolling_damping_ratio = 0.5\n"
                    "rolling_stiffness = 0.375\nrolling_damping = 1e-3\n");
  // Twisting friction defaults to friction.
  check_becomes("arithmetic", soft + "friction = 0.5\nrolling_friction = 0.25\n",
                hard + "friction = 0.5\nrolling_friction = 0.25\ntwisting_friction = 0.25\n",
                both + "friction = 0.5\nrolling_friction = 0.25\ntwisting_friction = 0.375\n");
  check_becomes("arithmetic", soft + "friction = 0.5\nwear_coefficient = 1e-12\n",
                hard + "friction = 0.5\nwear_coefficient = 3e-12\n",
                both + "friction = 0.5\nwear_coefficient = 2e-12\n");
  check_becomes("arithmetic", soft + "attraction = 1.0\nattraction_range = 1e-3\n",
                hard + "attraction = 2.0\nattraction_range = 2e-3\n",
                both + "attraction = 1.5\nattraction_range = 1.5e-3\n");
}

TEST_CASE("of materials with moduli the exact effective ones, whatever the rule") {
  for (const std::string rule : {"geometric", "minimum"}) {
    check_becomes(rule, "restitution = 0.5\nfriction = 0.25\n", "restitution = 0.5\nfriction = 0.25\n",
                  "restitution = 0.5\nfriction = 0.25\n", kMetals);
    const Model made = model_of(deck_of(rule, "friction = 0.25\n", "friction = 0.25\n", kMetals));
    CHECK(near(made.contact.law(0, 1).effective_modulus, 1 / (0.91 / 2e8 + 0.96 / 1e7),
               {.relative = kRoundOff}));
    CHECK(near(made.contact.friction_of(0, 1).shear_modulus, 1 / (2 * 1.7 * 1.3 / 2e8 + 2 * 1.8 * 1.2 / 1e7),
               {.relative = kRoundOff}));
  }
  check_becomes("geometric", "work_of_adhesion = 0.02\n", "surface_energy = 0.04\n",
                "work_of_adhesion = 0.04\n", kMetals);
  check_becomes("minimum", "surface_energy = 0.02\nadhesion = \"dmt\"\n",
                "surface_energy = 0.04\nadhesion = \"dmt\"\n", "surface_energy = 0.02\nadhesion = \"dmt\"\n",
                kMetals);
  check_becomes("arithmetic", "plasticity_ratio = 0.5\nwork_of_adhesion = 2.0\nadhesion_exponent = 2.0\n",
                "plasticity_ratio = 0.75\nwork_of_adhesion = 4.0\nadhesion_exponent = 2.0\n",
                "plasticity_ratio = 0.625\nwork_of_adhesion = 3.0\nadhesion_exponent = 2.0\n", kMetals);
}

TEST_CASE("derived pairs are listed in the model as keys, in the order of the materials") {
  const Model made = model_of(deck_of("geometric", "stiffness = 1e5\nfriction = 0.2\nrestitution = 0.9\n",
                                      "stiffness = 1e5\nfriction = 0.8\n"));
  REQUIRE(made.contact.combined.size() == 1);
  CHECK((made.contact.combined[0].material[0] == 0 && made.contact.combined[0].material[1] == 1));
  CHECK(made.contact.combined[0].keys ==
        "stiffness = 100000, restitution = 0.9486832980505138, friction = 0.4");
}

TEST_CASE("every key of a pair is mixed") {
  // A new key must declare how it is combined, and be in this list.
  const std::vector<std::string> known = {"materials",
                                          "stiffness",
                                          "largest_overlap",
                                          "impact_speed",
                                          "damping",
                                          "exponent",
                                          "restitution",
                                          "limit_damping",
                                          "friction",
                                          "tangential_stiffness",
                                          "tangential_damping_ratio",
                                          "rolling_friction",
                                          "rolling_stiffness",
                                          "rolling_damping_ratio",
                                          "rolling_damping",
                                          "twisting_friction",
                                          "wear_coefficient",
                                          "work_of_adhesion",
                                          "surface_energy",
                                          "adhesion",
                                          "attraction",
                                          "attraction_range",
                                          "plasticity_ratio",
                                          "adhesion_exponent",
                                          "bridge_volume",
                                          "surface_tension",
                                          "contact_angle",
                                          "bridge_force",
                                          "bridge_viscosity",
                                          "bridge_least_gap"};
  for (const Key& key : contact_keys().keys) {
    if (key.name != "pairs") continue;
    CHECK(key.table->keys.size() == known.size());
    for (const Key& of_pair : key.table->keys) {
      INFO(of_pair.name);
      CHECK(std::count(known.begin(), known.end(), of_pair.name) == 1);
      CHECK(of_pair.combining != Combining::none);
    }
  }
}

TEST_CASE("pairs that cannot be made are refused") {
  const std::string soft = "stiffness = 1e5\n";
  const auto refused = [](const std::string& of_a, const std::string& of_b, const std::string& message,
                          const std::string& materials = kMaterials) {
    const std::string error = model_error(deck_of("geometric", of_a, of_b, materials));
    INFO(error);
    CHECK(contains(error, message));
    CHECK(contains(error, "deck.toml:"));
  };
  const std::string end =
      ", so that contact.mixing cannot make the pair [\"a\", \"b\"]; give it in [[contact.pairs]]";
  CHECK(contains(model_error(deck_of("", soft, soft)),
                 ": no pair with materials = [\"a\", \"b\"], which can meet; every pair that can "
                 "meet must be given in [[contact.pairs]], unless contact.mixing says how it follows"));
  CHECK(contains(model_error(deck_of("wet", soft, soft)), "contact.mixing = \"wet\": must be one of"));
  CHECK(contains(
      model_error(whole_deck(kMaterials, "mixing = \"minimum\"\n", pair_of("a", "a", soft))),
      "deck.toml:11:10: contact.mixing = \"minimum\": [\"a\", \"b\"], which can meet, needs the pair "
      "[\"b\", \"b\"] in [[contact.pairs]], to be combined of; give that pair, or this one"));
  refused(soft, soft + "exponent = 1.5\n",
          "contact.pairs.1.exponent = 1.5: differs from the 1 of the pair [\"a\", \"a\"]" + end);
  refused(soft, soft + "limit_damping = false\n", "limit_damping = false: differs from the true of the pair");
  refused("stiffness = 0.0\n", soft,
          "contact.pairs.0.stiffness = 0.0: is 0, and that of the pair [\"b\", \"b\"] is not" + end);
  refused(soft, soft + "friction = 0.5\n",
          "contact.pairs.1.friction = 0.5: the pair [\"a\", \"a\"] has none" + end);
  refused(soft + "damping = 1.0\n", soft + "restitution = 0.5\n",
          "contact.pairs.0.damping = 1.0: the pair [\"b\", \"b\"] has a restitution" + end);
  refused("largest_overlap = 0.01\nimpact_speed = 1.0\n", "largest_overlap = 0.02\nimpact_speed = 1.0\n",
          "contact.pairs.1.largest_overlap = 0.02: differs from the 0.01");
  refused(soft + "friction = 0.5\nrolling_friction = 0.1\n",
          soft + "friction = 0.5\nrolling_friction = 0.1\nrolling_stiffness = 0.1\n",
          "contact.pairs.1.rolling_stiffness = 0.1: the pair [\"a\", \"a\"] has none" + end);
  refused(soft + "friction = 0.5\n", soft + "friction = 0.5\ntwisting_friction = 0.1\n",
          "contact.pairs.1.twisting_friction = 0.1: the pair [\"a\", \"a\"] has none" + end);
  refused("stiffness = 1e8\nexponent = 1.5\nfriction = 0.5\ntangential_stiffness = 1e4\n",
          "stiffness = 1e8\nexponent = 1.5\nfriction = 0.5\n",
          "contact.pairs.1.tangential_stiffness: missing");
  refused("work_of_adhesion = 0.1\n", "", "contact.pairs.0.work_of_adhesion = 0.1: the pair", kMetals);
  refused("work_of_adhesion = 0.1\n", "work_of_adhesion = 0.1\nadhesion = \"dmt\"\n", "adhesion = ", kMetals);
}

}  // namespace scree
