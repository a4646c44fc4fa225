// The default step and the default integrator.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "model/checks/explicit_step.hpp"
#include "model/checks/impact_trials.hpp"
#include "model/checks/limits.hpp"
#include "physics/step_limits.hpp"
#include "run/report/rebound_check.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

class RandomDecks {
 public:
  explicit RandomDecks(unsigned seed) : engine_(seed) {}
  // Spheres or discs between walls, with any law, and further contact partners.
  std::string next();

 private:
  Real between(Real low, Real high) { return std::uniform_real_distribution<Real>(low, high)(engine_); }
  // Uniform in the logarithm.
  Real of_size(Real low, Real high) { return std::exp(between(std::log(low), std::log(high))); }
  bool maybe(Real chance) { return between(0, 1) < chance; }
  std::string law(bool spheres, Real radius, Real mass, Real speed);
  std::string resistance();
  std::string body(bool spheres, Real radius, Real mass);

  std::mt19937 engine_;
};

std::string RandomDecks::resistance() {
  std::string text = fmt::format("friction = {}\n", between(0.05, 1));
  if (maybe(0.6)) text += fmt::format("tangential_damping_ratio = {}\n", between(0.05, 1));
  if (maybe(0.4))
    text +=
        fmt::format("rolling_friction = {}\nrolling_damping_ratio = {}\n", between(0.01, 0.4), between(0, 1));
  return text;
}

// Stiff enough for overlaps of at most a tenth of the radius.
std::string RandomDecks::law(bool spheres, Real radius, Real mass, Real speed) {
  const std::string restitution = fmt::format("restitution = {}\n", between(0.05, 1));
  const Real stiffness = mass * speed * speed / (radius * radius) * of_size(100, 1e5);
  const bool has_friction = maybe(0.6);
  if (!spheres || maybe(0.4)) {
    std::string text = fmt::format("stiffness = {}\n", stiffness);
    text += maybe(0.5)
                ? restitution
                : fmt::format("damping = {}\n", 2 * std::sqrt(stiffness * mass / 2) * between(0, 0.95));
    if (maybe(0.2)) text += fmt::format("attraction = {}\nattraction_range = {}\n", 5 * mass, 0.05 * radius);
    return text + (has_friction ? resistance() : "");
  }
  const Real work = 1e-3 * stiffness * radius;  // some overlaps of a tenth of a per cent
  if (maybe(0.3))
    return restitution + fmt::format("work_of_adhesion = {}\nadhesion = \"jkr\"\n", work) + resistance();
  if (maybe(0.3))
    return restitution + fmt::format("work_of_adhesion = {}\nadhesion = \"dmt\"\n", work) +
           (has_friction ? resistance() : "");
  if (maybe(0.3))
    return restitution +
           fmt::format(
               "bridge_volume = {}\nsurface_tension = {}\ncontact_angle = {}\nbridge_force = \"{}\"\n",
               of_size(1e-5, 0.05), 1e-4 * stiffness, between(0, 0.9), maybe(0.5) ? "soulie" : "willett") +
           resistance();
  return restitution + (has_friction ? resistance() : "");
}

std::string RandomDecks::body(bool spheres, Real radius, Real mass) {
  const Real heavy = of_size(0.3, 100) * mass, inertia = 0.4 * heavy * radius * radius * of_size(0.5, 30);
  if (!spheres)
    return fmt::format(
        "[[bodies]]\nname = \"b\"\nposition = [0, {}]\nmass = {}\ninertia = {}\nshapes = [{{ radius = {} "
        "}}]\n",
        20 * radius, heavy, inertia, 2 * radius);
  const std::string mesh =
      fmt::format("[[meshes]]\nname = \"m\"\nkind = \"box\"\nsize = [{0}, {0}, {0}]\n", 3 * radius);
  return (maybe(0.5) ? mesh : "") +
         fmt::format(
             "[[bodies]]\nname = \"b\"\nkind = \"spatial\"\nposition = [0, 0, {}]\nmass = {}\n"
             "inertia_tensor = [{}, {}, {}, 0, 0, 0]\n",
             20 * radius, heavy, inertia, inertia, inertia);
}

std::string RandomDecks::next() {
  const bool spheres = maybe(0.7);
  const Real radius = of_size(1e-4, 0.1), density = of_size(500, 8000), height = 50 * radius;
  const Real mass = spheres ? 4.19 * density * radius * radius * radius : 3.14 * density * radius * radius;
  const Real speed = std::sqrt(2 * 9.81 * 2 * height);
  const std::string low = spheres ? fmt::format("[{0}, {0}, {0}]", -height)
                                  : fmt::format("[{0}, {0}]", -height),
                    high =
                        spheres ? fmt::format("[{0}, {0}, {0}]", height) : fmt::format("[{0}, {0}]", height);
  std::string deck = spheres ? "gravity = [0, 0, -9.81]\n" : "gravity = [0, -9.81]\n";
  deck +=
      fmt::format("[space]\ndimension = {}\nmin = {}\nmax = {}\ny_min = \"wall\"\nwall_material = \"w\"\n",
                  spheres ? 3 : 2, low, high);
  deck += fmt::format("[time]\nend = 1.0\n[integrator]\nparticles = \"velocity-verlet\"\nsubsteps = {}\n",
                      maybe(0.3) ? 4 : 1);
  const std::string one = law(spheres, radius, mass, speed);
  // Moduli with which spheres overlap by a fraction of a per cent to some per cent.
  const std::string moduli = contains(one, "stiffness")
                                 ? ""
                                 : fmt::format("young_modulus = {}\npoisson_ratio = 0.3\n",
                                               density * speed * speed * of_size(1e3, 1e6));
  for (const char* name : {"p", "w"}) deck += fmt::format("[[materials]]\nname = \"{}\"\n{}", name, moduli);
  for (const char* pair : {"\"p\", \"p\"", "\"p\", \"w\"", "\"w\", \"w\""})
    deck += fmt::format("[[contact.pairs]]\nmaterials = [{}]\n{}", pair, one);
  deck += fmt::format(
      "[[particles]]\nkind = \"list\"\nmaterial = \"p\"\npositions = [{}]\nradius = {{ kind = "
      "\"uniform\", min = {}, max = {} }}\ndensity = {}\n",
      spheres ? fmt::format("[0, 0, 0], [{}, 0, 0]", 3 * radius) : fmt::format("[0, 0], [{}, 0]", 3 * radius),
      radius, of_size(1, 3) * radius * 1.01 < 1.4 * radius ? 1.4 * radius : 1.01 * radius, density);
  if (!spheres) deck += "thickness = 1.0\n";
  std::string with = maybe(0.6) ? body(spheres, radius, mass) : "";
  if (!with.empty()) {
    const bool mesh = with.starts_with("[[meshes]]");
    const bool planar = !spheres;
    if (planar)
      with.insert(with.rfind(" }]"), ", material = \"w\"");
    else
      with += mesh ? "meshes = [{ mesh = \"m\", material = \"w\" }]\n"
                   : fmt::format("shapes = [{{ radius = {}, material = \"w\" }}]\n", 2 * radius);
  }
  return deck + with;
}

struct Built {
  Model model;
  std::vector<ChosenValue> chosen;
  std::vector<std::string> warnings;

  const ChosenValue* of(const std::string& key) const {
    const auto found = std::ranges::find(chosen, key, &ChosenValue::key);
    return found == chosen.end() ? nullptr : &*found;
  }
};

Built built(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Built result;
  Log log(true);
  result.model = build_model(parse_deck(text, "deck.toml", overrides), log, Share(), result.chosen);
  result.warnings = log.warnings();
  return result;
}

}  // namespace

TEST_CASE("a step that is chosen is neither refused nor warned about, and keeps rebounds within 2 %") {
  RandomDecks decks(41);
  int longest_trials = 0;
  for (int k = 0; k < 60; ++k) {
    const std::string deck = decks.next();
    INFO(deck);
    const Built one = built(deck);
    REQUIRE(one.of("step") != nullptr);
    CHECK(std::get<Real>(one.of("step")->value) == one.model.time.step);
    for (const std::string& warning : one.warnings) CHECK_FALSE(contains(warning, "time.step"));
    CHECK(step_warning(one.model).empty());
    const Real h = one.model.time.step / one.model.integrator.substeps;
    for (const StepTrial& trial : try_steps(one.model)) CHECK(trial.result.error() < kReboundTolerance);
    for (const PairLimit& limit : explicit_pairs(one.model))
      CHECK(h <= kStableStepFraction * limit.explicit_step);
    CHECK(one.model.time.step <= body_step_limit(one.model).good_step());
    CHECK(suits_explicit(one.model, one.model.time.step));
    // No default step is much shorter than necessary.
    longest_trials += contains(one.of("step")->reason, "trial rebounds");
  }
  CHECK(longest_trials > 10);
}

TEST_CASE("numbers are rounded down to two digits, and to what a deck reads") {
  CHECK(two_digits_below(1.2999e-5) == 1.2e-5);
  CHECK(two_digits_below(1.2e-5) == 1.2e-5);
  CHECK(two_digits_below(0.99999) == 0.99);
  CHECK(two_digits_below(123.0) == 120);
}

// Discs in a box.
TEST_CASE("the integrator follows from what the deck has, and what it names") {
  const std::string deck = R"(
gravity = [0.0, -9.81]
[space]
dimension = 2
min = [0.0, 0.0]
max = [2.0, 2.0]
x_min = "wall"
y_min = "wall"
[time]
end = 0.1
[[contact.pairs]]
stiffness = 1e5
restitution = 0.5
[[particles]]
name = "d"
kind = "lattice"
origin = [0.1, 0.1]
spacing = [0.11, 0.11]
size = [5, 10]
radius = 0.05
mass = 0.1
)";
  const std::string few = "particles.d.count=", friction = "contact.pairs.0.friction=0.4";
  struct Case {
    std::vector<std::string> overrides;
    bool is_explicit;
    std::string reason;
  };
  const std::vector<Case> cases = {
      {{}, true, "50 particles may touch, without friction: from 50 on explicit steps cost less"},
      {{few + "49"}, false, "49 particles may touch, without friction: fewer than 50"},
      {{few + "20", friction}, true, "20 particles may touch, with friction: from 20 on"},
      {{few + "19", friction}, false, "19 particles may touch, with friction: fewer than 20"},
      {{few + "2", friction, "contact.pairs.0.rolling_friction=0.1"}, true, "rolling or twisting resistance"},
      {{few + "2", "contact.pairs.0.attraction=1.0"}, true, "adhesion"},
      {{"contact.pairs=[{stiffness=0,damping=0}]"}, false, "no particle touches anything"},
      {{"time.control=adaptive"}, false, "time.control = \"adaptive\""},
      {{"time.tolerance=1e-7"}, false, "time.tolerance"},
      {{"time.max_step=1e-3"}, false, "time.max_step"},
      {{"integrator.contact_events=end-of-step"}, false, "integrator.contact_events"},
      {{few + "2", "integrator.substeps=2"}, true, "integrator.substeps"},
      {{few + "2", "integrator.precision=mixed"}, true, "integrator.precision = \"mixed\""},
      {{"time.step=1e-3", "time.control=fixed"},
       false,
       "time.step = 0.001 s is named and fixed, and too long"},
      {{"time.step=1e-5", "time.control=fixed"}, true, "50 particles may touch"}};
  for (const Case& one : cases) {
    CAPTURE(one.overrides);
    const Built model = built(deck, one.overrides);
    REQUIRE(model.of("particles") != nullptr);
    CHECK(std::get<std::string>(model.of("particles")->value) ==
          (one.is_explicit ? "velocity-verlet" : "hht"));
    CHECK((model.model.integrator.particles == ParticleIntegrator::velocity_verlet) == one.is_explicit);
    CHECK((model.model.time.control == StepControl::fixed) ==
          (one.is_explicit || std::ranges::count(one.overrides, "time.control=fixed") > 0));
    CAPTURE(model.of("particles")->reason);
    CHECK(contains(model.of("particles")->reason, one.reason));
    const bool names_step = one.overrides.size() > 0 && one.overrides[0].starts_with("time.step");
    CHECK((model.of("step") != nullptr) == (one.is_explicit && !names_step));
  }
  for (const char* named : {"hht", "velocity-verlet"}) {
    const Built model = built(deck, {std::string("integrator.particles=") + named});
    CHECK(model.of("particles") == nullptr);
    CHECK((model.of("step") != nullptr) == (named == std::string("velocity-verlet")));
  }
  // The refusal of an integrator names both keys that require it.
  CHECK(contains(model_error(deck, {"contact.pairs.0.attraction=0.1", "contact.pairs.0.attraction_range=0.1",
                                    "time.control=adaptive"}),
                 "needs integrator.particles = \"velocity-verlet\""));
  CHECK(contains(model_error(deck, {"integrator.particles=hht", "time.control=fixed"}),
                 "time.step: missing; with control = \"fixed\" and implicit steps"));
}

TEST_CASE("the resolved deck has what was chosen with its reason, and is the same deck") {
  const std::string text = R"(
[space]
dimension = 2
min = [0.0, 0.0]
max = [2.0, 2.0]
[time]
end = 0.1
[[contact.pairs]]
stiffness = 1e5
friction = 0.5
[[particles]]
kind = "lattice"
origin = [0.1, 0.1]
spacing = [0.11, 0.11]
size = [5, 5]
radius = 0.05
mass = 0.1
)";
  Deck deck = parse_deck(text, "deck.toml", {});
  const Built one = built(text);
  for (const ChosenValue& value : one.chosen) deck.root.take(value);
  const std::string resolved = deck.resolved_text();
  CAPTURE(resolved);
  CHECK(contains(resolved, "particles = \"velocity-verlet\"  # chosen: 25 particles may touch"));
  CHECK(contains(resolved, fmt::format("step = {}  # chosen: ", one.model.time.step)));
  CHECK(contains(resolved, "control = \"fixed\"\n"));
  CHECK_FALSE(contains(resolved, "tolerance = 2e-08"));
  const Deck again = parse_deck(resolved, "resolved.toml", {});
  CHECK(again.fingerprint() == deck.fingerprint());
  const Built same = built(resolved);
  CHECK(same.chosen.empty());
  CHECK(same.model.time.step == one.model.time.step);
  CHECK_FALSE(contains(deck.fingerprint(), "chosen"));
  // Whatever the run's end and outputs, the step is the same.
  CHECK(built(text, {"time.end=7.0", "output.history_interval=0.01"}).model.time.step == one.model.time.step);
}

TEST_CASE("warnings and refusals of a step name the one that is chosen where it is left out") {
  const std::string deck = R"(
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 1.0
step = 1e-4
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
restitution = 0.3
[[particles]]
kind = "list"
positions = [[0, 0], [0.2, 0]]
radius = 0.05
mass = 0.1
)";
  const Real step = longest_explicit_step(model_of(deck)).step;
  const std::string remedy = fmt::format("; left out, it is {:g} s: ", step);
  CHECK(contains(step_warning(model_of(deck, {"time.step=6e-4"})), remedy));
  CHECK(contains(model_error(deck, {"time.step=1e-2"}), remedy));
  CHECK(step_warning(model_of(deck, {fmt::format("time.step={:g}", step)})).empty());
}

}  // namespace scree
