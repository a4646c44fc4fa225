// Results of the keys of a pair: restitution beside a stiffness, stiffness from a largest overlap or from
// moduli in 2D, rolling and twisting; and refusals.
#include <fmt/format.h>

#include <numbers>

#include "model/checks/limits.hpp"
#include "physics/normal_laws.hpp"
#include "physics/plausible.hpp"
#include "physics/restitution.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/restitution.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;

// Two spheres, or two discs, that fall on nothing. pair: keys.
std::string deck_of(const std::string& pair, int dimension = 3, const std::string& grain = "mass = 0.1\n") {
  return std::string("[space]\ndimension = ") + (dimension == 2 ? "2" : "3") + "\nmin = [-1.0, -1.0" +
         (dimension == 2 ? "" : ", -1.0") + "]\nmax = [1.0, 1.0" + (dimension == 2 ? "" : ", 1.0") +
         "]\n[time]\nend = 1.0\nstep = 1e-6\n[integrator]\nparticles = \"velocity-verlet\"\n"
         "[[particles]]\nname = \"grains\"\nkind = \"row\"\ncount = 2\norigin = [0.0, 0.0" +
         (dimension == 2 ? "" : ", 0.0") + "]\nspacing = [0.5, 0.0" + (dimension == 2 ? "" : ", 0.0") +
         "]\nradius = 0.02\n" + grain + "[[contact.pairs]]\n" + pair;
}
const std::string kSoft = "[[materials]]\nname = \"soft\"\nyoung_modulus = 1e7\npoisson_ratio = 0.3\n";

const NormalLawParameters& law_of(const Model& model) { return model.contact.law(0, 0); }

}  // namespace

TEST_CASE("a restitution beside a stiffness becomes a damping ratio") {
  for (const bool tension : {false, true}) {
    const std::string pulls = tension ? "limit_damping = false\n" : "";
    const Model linear = model_of(deck_of("stiffness = 1e5\nrestitution = 0.4\n" + pulls));
    CHECK(near(restitution_of(law_of(linear).damping_ratio, tension), 0.4, {.relative = kRoundOff}));
    CHECK(law_of(linear).normal_damping == 0);
    const PairSize size{0.02, 0.02, 0.1, 0.1};
    CHECK(near(LinearRestitutionLaw(law_of(linear)).of_pair(size).damping(1e-4),
               contact_damping(law_of(linear).damping_ratio, 0.05, 1e5, 1), {.relative = kRoundOff}));
    const Model power = model_of(deck_of("stiffness = 1e6\nexponent = 2.0\nrestitution = 0.4\n" + pulls));
    CHECK(near(PowerLaw(law_of(power)).of_pair(size).damping(1e-4),
               contact_damping(law_of(power).damping_ratio, 0.05, 1e6, 2) * 1e-2, {.relative = kRoundOff}));
  }
  // Damping shortens the explicit step.
  const auto step = [](const std::string& e) {
    return pair_limits(model_of(deck_of("stiffness = 1e5\n" + e)))[0].explicit_step;
  };
  CHECK(step("restitution = 0.3\n") < step(""));
  CHECK(step("restitution = 1.0\n") == step(""));
}

TEST_CASE("the mean damping and the cut of a power law with a restitution") {
  const PowerLaw law = PowerLaw({1e6, 0, 1.7, false, 0, 0.3}).of_pair({0.02, 0.02, 0.1, 0.1});
  for (const Real d0 : {0.0, 1e-4, 9.9999e-4, 1e-3}) {
    const Real d1 = 1e-3;
    Real sum = 0;
    constexpr int kParts = 100000;
    for (int k = 0; k < kParts; ++k) sum += law.damping(d0 + (k + 0.5) / kParts * (d1 - d0)) / kParts;
    CHECK(near(law.mean_damping(d0, d1), sum, {.relative = 1e-6}));
  }
  const Real d0 = 1e-3, rate = 0.1, pull = law.damping(d0) * rate, cut = law.cut(d0, pull);
  CHECK(near(law.elastic(cut), law.damping(cut) * rate, {.relative = 1e-12}));
}

TEST_CASE("a stiffness from a largest overlap gives it at the impact's speed") {
  for (const Real exponent : {1.0, 1.5, 2.0}) {
    const std::string keys = fmt::format(
        "largest_overlap = 0.02\nimpact_speed = 3.0\nexponent = {}\nrestitution = 0.9\n", exponent);
    const Model pair = model_of(deck_of(keys));
    CHECK(near(impact_overlap(law_of(pair), 0.05, 3), 0.02 * 0.02, {.relative = 1e-12}));
    const Model floor = model_of(deck_of(keys), {"space.z_min=wall"});
    CHECK(near(impact_overlap(law_of(floor), 0.1, 3), 0.02 * 0.02, {.relative = 1e-12}));
  }
}

TEST_CASE("moduli of discs become a linear stiffness for their thickness") {
  const std::string grain = "density = 2000.0\nthickness = 0.01\n";
  const Model model = model_of(kSoft + deck_of("restitution = 0.5\nfriction = 0.3\n", 2, grain));
  const Real modulus = 1e7 / (2 * (1 - 0.09));
  CHECK(near(law_of(model).normal_stiffness, std::numbers::pi / 4 * modulus * 0.01, {.relative = kRoundOff}));
  CHECK((law_of(model).effective_modulus == 0 && law_of(model).exponent == 1));
  CHECK(near(restitution_of(law_of(model).damping_ratio, false), 0.5, {.relative = kRoundOff}));
  CHECK(near(model.contact.friction_of(0, 0).stiffness, Real(2) / 7 * law_of(model).normal_stiffness,
             {.relative = kRoundOff}));
  CHECK(contains(model_error(kSoft + deck_of("", 2)),
                 "contact.pairs.0.stiffness: missing; from moduli it follows for discs of one thickness, and "
                 "here all masses are given"));
}

TEST_CASE("keys of rolling and twisting become the pair's resistance") {
  const auto rolling = [](const std::string& keys, int dimension = 3) {
    return model_of(deck_of("stiffness = 1e5\nfriction = 0.4\n" + keys, dimension)).contact.rolling_of(0, 0);
  };
  CHECK(model_of(deck_of("stiffness = 1e5\nfriction = 0.4\n")).contact.rolling.empty());
  const RollingParameters spring = rolling("rolling_friction = 0.1\nrolling_damping_ratio = 0.3\n");
  CHECK((spring.friction == 0.1 && spring.damping_ratio == 0.3 && spring.stiffness_factor == 2.25 &&
         spring.stiffness == 0 && spring.damping == 0 && spring.twisting_friction == 0.4));
  const RollingParameters given =
      rolling("rolling_friction = 0.1\nrolling_stiffness = 0.7\ntwisting_friction = 0.0\n");
  CHECK((given.stiffness == 0.7 && given.stiffness_factor == 0 && given.twisting_friction == 0));
  const RollingParameters flat = rolling("rolling_friction = 0.1\nrolling_damping = 2e-4\n", 2);
  CHECK((flat.stiffness_factor == 3 && flat.damping == 2e-4 && flat.twisting_friction == 0));
  const RollingParameters twisting = rolling("twisting_friction = 0.2\n");
  CHECK((twisting.friction == 0 && twisting.damping == 0 && twisting.twisting_friction == 0.2));
}

TEST_CASE("stiff rolling springs shorten the explicit step, soft ones do not") {
  const auto step = [](const std::string& keys, const std::vector<std::string>& overrides = {}) {
    const Model model = model_of(deck_of("stiffness = 1e5\nfriction = 0.4\n" + keys), overrides);
    return pair_limits(model)[0].explicit_step;
  };
  CHECK(step("rolling_friction = 0.3\n") == step(""));
  CHECK(step("rolling_friction = 0.3\nrolling_stiffness = 80.0\n") < 0.8 * step(""));
  CHECK(step("rolling_friction = 0.3\nrolling_damping_ratio = 5.0\n") < step(""));
  CHECK(step("rolling_damping = 1.0\n") < step(""));
}

TEST_CASE("errors of a pair's keys are refused with a remedy") {
  struct Case {
    std::string keys, message;
  };
  for (const Case& c : std::initializer_list<Case>{
           {"stiffness = 1e5\ndamping = 3.0\nrestitution = 0.5\n",
            "restitution = 0.5: stands beside a damping; give one of the two"},
           {"stiffness = 0.0\nrestitution = 0.5\n",
            "restitution = 0.5: must be left out where the stiffness"},
           {"stiffness = 1e5\nexponent = 0.8\nrestitution = 0.5\n",
            "restitution = 0.5: needs an exponent of at least 1"},
           {"stiffness = 1e5\nlargest_overlap = 0.01\nimpact_speed = 1.0\n",
            "largest_overlap = 0.01: stands beside a stiffness"},
           {"damping = 1.0\nlargest_overlap = 0.01\nimpact_speed = 1.0\n",
            "damping = 1.0: must be left out beside largest_overlap; give a restitution instead"},
           {"largest_overlap = 0.01\n", "impact_speed: missing"},
           {"stiffness = 1e5\nimpact_speed = 1.0\n", "impact_speed = 1.0: needs largest_overlap"},
           {"stiffness = 1e5\nrolling_friction = 0.1\n", "rolling_friction = 0.1: needs friction"},
           {"stiffness = 1e5\nrolling_damping = 0.1\n", "rolling_damping = 0.1: needs friction"},
           {"stiffness = 1e5\ntwisting_friction = 0.1\n", "twisting_friction = 0.1: needs friction"},
           {"stiffness = 1e5\nfriction = 0.1\nrolling_stiffness = 0.1\n",
            "rolling_stiffness = 0.1: needs rolling_friction"},
           {"stiffness = 1e5\nfriction = 0.1\nrolling_damping_ratio = 0.1\n",
            "rolling_damping_ratio = 0.1: needs rolling_friction"}}) {
    CAPTURE(c.keys);
    CHECK(contains(model_error(deck_of(c.keys)), "contact.pairs.0." + c.message));
  }
  CHECK(contains(model_error(deck_of("stiffness = 1e5\nfriction = 0.1\ntwisting_friction = 0.1\n", 2)),
                 "twisting_friction = 0.1: must be left out in 2D"));
}

}  // namespace scree
