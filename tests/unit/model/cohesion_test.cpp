// Keys of cohesion: the resulting laws, the search range, and refusals.
#include "physics/cohesion.hpp"

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "model/checks/limits.hpp"
#include "physics/restitution.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/restitution.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;

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
material = "soft"
)";
const std::string kSoft = "[[materials]]\nname = \"soft\"\nyoung_modulus = 1e7\npoisson_ratio = 0.3\n";
const std::string kBare = "[[materials]]\nname = \"soft\"\n";

std::string pair_of(const std::string& keys) {
  return "[[contact.pairs]]\nmaterials = [\"soft\", \"soft\"]\n" + keys;
}
std::string hertz(const std::string& keys) { return kSoft + kGrains + pair_of(keys); }
std::string linear(const std::string& keys) { return kBare + kGrains + pair_of("stiffness = 1e5\n" + keys); }

}  // namespace

TEST_CASE("a work of adhesion, or twice a surface energy, is the pair's, with JKR or DMT") {
  const Model jkr = model_of(hertz("work_of_adhesion = 0.5\nrestitution = 0.6\n"));
  const NormalLawParameters& law = jkr.contact.law(0, 0);
  CHECK((law.adhesion_work == 0.5 && law.jkr));
  CHECK(near(restitution_of(law.damping_ratio, true), 0.6, {.relative = kRoundOff}));
  CHECK(jkr.rotates());  // a JKR contact rotates with its partners
  // The largest interaction range is that of a sphere on a plane; the search range is a quarter larger.
  const Real on_plane = JkrLaw(law).of_pair({0.02, kInfinity, 1, 1}).interaction_range();
  CHECK(near(jkr.contact.interaction_range, 1.25 * on_plane, {.relative = 1e-8}));
  CHECK(jkr.contact.interaction_range > JkrLaw(law).of_pair({0.02, 0.02, 1, 1}).interaction_range());
  const NormalLawParameters same = model_of(hertz("surface_energy = 0.25\n")).contact.law(0, 0);
  CHECK((same.adhesion_work == 0.5 && same.jkr));
  const Model dmt = model_of(hertz("work_of_adhesion = 0.5\nadhesion = \"dmt\"\n"));
  CHECK((!dmt.contact.law(0, 0).jkr && dmt.contact.interaction_range == 0 && !dmt.rotates()));
  CHECK(!model_of(hertz("work_of_adhesion = 0.0\n")).contact.law(0, 0).is_cohesive());
  // A JKR contact is stiffer than one without cohesion.
  CHECK(pair_limits(jkr)[0].explicit_step <
        pair_limits(model_of(hertz("friction = 0.0\n")))[0].explicit_step);
}

TEST_CASE("a constant attraction adds to a linear law or Hertz's") {
  const Model near_only = model_of(linear("attraction = 2.0\n"));
  CHECK((near_only.contact.law(0, 0).attraction == 2 && near_only.contact.interaction_range == 0));
  const Model far = model_of(linear("attraction = 2.0\nattraction_range = 1e-6\n"));
  CHECK(far.contact.interaction_range == 1e-6);
  CHECK(pair_limits(far)[0].stiffness == 2e6);  // A / range, steeper than the spring
  CHECK(model_of(hertz("attraction = 2.0\n")).contact.law(0, 0).attraction == 2);
}

TEST_CASE("an attraction that reaches farther than a radius is warned of") {
  const auto warned = [](const std::string& range) {
    const std::vector<std::string> texts =
        model_warnings(linear("attraction = 1e-3\nattraction_range = " + range + "\n"));
    return std::count_if(texts.begin(), texts.end(), [](const std::string& text) {
      return contains(text, "adhesion acts up to 0.021 m beyond contact, more than the smallest radius");
    });
  };
  CHECK(warned("0.021") == 1);
  CHECK(warned("0.019") == 0);
}

TEST_CASE("incompatible keys beside attraction are refused with a remedy") {
  CHECK(contains(model_error(linear("work_of_adhesion = 0.1\n")),
                 "contact.pairs.0.work_of_adhesion = 0.1: needs Hertz's law: young_modulus"));
  CHECK(contains(model_error(hertz("work_of_adhesion = 0.1\nsurface_energy = 0.05\n")),
                 "surface_energy = 0.05: stands beside work_of_adhesion; give one of the two"));
  for (const std::string form : {"jkr", "dmt"})
    CHECK(contains(model_error(hertz("adhesion = \"" + form + "\"\n")),
                   "contact.pairs.0.adhesion = \"" + form + "\": needs work_of_adhesion or surface_energy"));
  CHECK(contains(model_error(linear("exponent = 1.5\nattraction = 0.1\n")),
                 "attraction = 0.1: needs a pair with exponent = 1, or Hertz's law"));
  CHECK(
      contains(model_error(linear("attraction_range = 0.1\n")), "attraction_range = 0.1: needs attraction"));
  CHECK(contains(model_error(hertz("work_of_adhesion = 0.1\nattraction = 0.1\n")),
                 "attraction = 0.1: a deck has adhesion = \"jkr\" for all pairs that attract, or \"dmt\""));
  const std::string energies[] = {"work_of_adhesion = 0.1\n", "surface_energy = 0.1\n"},
                    constant = "attraction = 0.1\n", range = "attraction_range = 0.1\n";
  const std::vector<std::string> implicit = {"integrator.particles=hht", "time.control=fixed"};
  for (const std::string& keys : {energies[0], energies[1], constant, constant + range})
    CHECK(model_of(hertz(keys), {"integrator.precision=mixed"}).is_cohesive());
  for (const std::string& keys : energies) {
    const std::string error = model_error(hertz(keys), implicit);
    CHECK(contains(error, "needs integrator.particles = \"velocity-verlet\""));
    CHECK(contains(error, "adhesion = \"dmt\" is possible"));
    CHECK(model_of(hertz(keys + "adhesion = \"dmt\"\n"), implicit).is_cohesive());
  }
  CHECK(contains(model_error(hertz(constant + range), implicit), "without attraction_range"));
  CHECK(model_of(hertz(constant), implicit).is_cohesive());
}

}  // namespace scree
