// Overlaps at the start, and steps against contact times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/checks/limits.hpp"
#include "model/derived/connections.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;  // of products and roots

const std::string kTwoDiscs = R"(
[[contact.pairs]]
stiffness = 1e4
[[particles]]
kind = "list"
positions = [[0.0, 0.0], [0.5, 0.5]]
radius = 0.05
mass = 1.0
)";
const std::string kDeck = kSmallDeck + kTwoDiscs;

std::string at(const std::string& positions) { return "particles.0.positions=" + positions; }

}  // namespace

TEST_CASE("overlapping particles: a warning, past the limit an error") {
  CHECK(model_warnings(kDeck).empty());
  CHECK(model_warnings(kDeck, {at("[[0, 0], [0.1, 0]]")}).empty());
  const std::vector<std::string> warnings = model_warnings(kDeck, {at("[[0, 0], [0.0995, 0], [0, 0.099]]")});
  REQUIRE(warnings.size() == 1);
  CHECK(
      warnings[0] ==
      "particle 0 and particle 2 overlap at t = 0 by 0.02 of the smaller radius, the largest of 2 overlaps; "
      "particle 0: of particles.0 at (0, 0), radius 0.05 m; particle 2: of particles.0 at (0, 0.099), radius "
      "0.05 m");
  const std::string message = model_error(kDeck, {at("[[0, 0], [0.09, 0]]")});
  CHECK(contains(message, "contact.max_start_overlap = 0.05"));
  CHECK(contains(
      message,
      "particle 0 and particle 1 overlap at t = 0 by 0.2 of the smaller radius; allowed: at most 0.05"));
  CHECK(model_error(kDeck, {at("[[0, 0], [0.09, 0]]"), "contact.max_start_overlap=0.3"}).empty());
  // A row of six in contact by turns: four of five gaps, two of them too small.
  CHECK(
      contains(model_error(kDeck, {at("[[0, 0], [0.09, 0], [0.189, 0], [0.279, 0], [0.378, 0], [0.5, 0]]")}),
               "allowed: at most 0.05; of 4 overlaps 2 are above it; particle 0: of particles.0 at (0, 0)"));
}

TEST_CASE("particles and shapes without a law may overlap at the start") {
  const std::string deck =
      kDeck +
      "[[materials]]\nname = \"air\"\n[[materials]]\nname = \"solid\"\n[[meshes]]\nname = \"line\"\n" +
      "kind = \"line\"\npoints = [[0.2, 0], [0.4, 0]]\n[[walls]]\nname = \"line\"\nmesh = \"line\"\n" +
      "material = \"solid\"\n";
  const auto error = [&](const std::string& positions, const std::string& stiffness) {
    return model_error(
        deck, {"contact.pairs=[{materials=[\"air\",\"air\"],stiffness=" + stiffness +
                   "},{materials=[\"air\",\"solid\"],stiffness=" + stiffness + "}]",
               "particles.0.material=air", "space.y_min=wall", "space.wall_material=solid", at(positions)});
  };
  for (const char* positions : {"[[0, 0], [0.03, 0]]", "[[0, -0.99]]", "[[0.3, 0.01]]"}) {
    CAPTURE(positions);
    CHECK(contains(error(positions, "1e4"), "overlap at t = 0"));
    CHECK(error(positions, "0").empty());
  }
}

TEST_CASE("overlaps with walls and across periodic sides") {
  const std::string wall = model_error(kDeck, {"space.y_min=wall", at("[[0, -0.96]]")});
  CHECK(contains(wall, "particle 0 and wall \"y_min\" overlap at t = 0 by 0.2"));
  const std::string periodic = model_error(
      kDeck, {"space.x_min=periodic", "space.x_max=periodic", at("[[-0.99, 0], [0, 0.5], [0.98, 0]]")});
  CHECK(contains(periodic, "particle 0 and particle 2 overlap at t = 0 by 1.4"));
}

TEST_CASE("overlaps of particles that start more than one period outside the space") {
  const std::vector<std::string> sides{"space.x_min=periodic", "space.x_max=periodic", "space.y_min=wall"};
  const auto error = [&](const std::string& positions) {
    std::vector<std::string> overrides = sides;
    overrides.push_back(at(positions));
    return model_error(kDeck, overrides);
  };
  // One period is 2 m.
  for (const char* x : {"0.01", "2.01", "4.01", "-3.99", "2000.01"}) {
    CAPTURE(x);
    CHECK(contains(error(fmt::format("[[0, 0], [0.5, 0.5], [{}, 0]]", x)),
                   "particle 0 and particle 2 overlap at t = 0 by 1.8"));
  }
  CHECK(contains(error("[[4.99, 0], [-4.98, 0]]"), "particle 0 and particle 1 overlap at t = 0 by 1.4"));
  CHECK(contains(error("[[5, -0.96]]"), "particle 0 and wall \"y_min\" overlap at t = 0 by 0.2"));
  CHECK(contains(error("[[5, 1.5]]"), "particle 0 starts at (5, 1.5), outside the space"));
  CHECK(error("[[0, 0], [5, 0], [4.5, 0]]").empty());
}

TEST_CASE("overlaps with bodies; connected bodies are left out") {
  const std::string bodies = R"([[bodies]]
name = "row"
count = 3
spacing = [0.08, 0.0]
mass = 1.0
inertia = 0.1
position = [-0.5, -0.5]
shapes = [{ radius = 0.05 }]
)";
  const std::string springs = "[[spring_dampers]]\nname = \"s\"\nchain = \"row\"\n";
  const std::string touching = model_error(kDeck + bodies);
  CHECK(contains(touching, "body \"row.0\" and body \"row.1\" overlap"));
  CHECK(
      contains(touching,
               "of 2 overlaps 2 are above it; body \"row.0\": its shape at (-0.5, -0.5), radius 0.05 m; body "
               "\"row.1\": its shape at (-0.42, -0.5)"));
  CHECK(contains(
      model_error(kDeck + bodies, {"bodies.row.shapes=[{radius=0.01},{radius=0.05,offset=[0,0.1]}]"}),
      "body \"row.0\": its shape 1 (from 0) at (-0.5, -0.4), radius 0.05 m"));
  CHECK(model_error(kDeck + bodies + springs).empty());
  CHECK(contains(model_error(kDeck + bodies + springs, {"contact.connected_bodies_touch=true"}),
                 "overlap at t = 0"));
  CHECK(contains(model_error(kDeck + bodies + springs, {at("[[-0.5, -0.42]]")}),
                 "particle 0 and body \"row.0\" overlap"));
  const Model model = model_of(kDeck + bodies + springs);
  CHECK(connected_bodies(model) == std::vector<std::pair<int, int>>{{0, 1}, {1, 2}});
}

TEST_CASE("the grid finds the worst overlap that brute force finds") {
  const std::string text = kSmallDeck + R"(
[contact]
max_start_overlap = 1.0
[[contact.pairs]]
stiffness = 1e4
[[particles]]
name = "a"
kind = "lattice"
center = [0.0, 0.0]
spacing = [0.07, 0.07]
size = [20, 20]
radius = { kind = "uniform", min = 0.01, max = 0.0345 }
mass = 1.0
[[particles]]
name = "b"
kind = "list"
positions = [[0.005, 0.003]]
radius = 0.02
mass = 1.0
)";
  const ParticleSet p = model_of(text).particles;
  Real worst = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Real overlap = p.radius[i] + p.radius[j] - norm(p.position[i] - p.position[j]);
      worst = std::max(worst, overlap / std::min(p.radius[i], p.radius[j]));
    }
  }
  REQUIRE(worst > 0);
  const std::string message = model_error(text, {"contact.max_start_overlap=1e-6"});
  CHECK(contains(message, fmt::format("by {:.6g} of the smaller radius", worst)));
}

TEST_CASE("the contact time is that of two equal discs") {
  const std::vector<PairLimit> limits = pair_limits(model_of(kDeck));
  REQUIRE(limits.size() == 1);
  CHECK(near(limits[0].contact_time, std::numbers::pi * std::sqrt(0.5 / 1e4), {.relative = kRoundOff}));
}

TEST_CASE("the first adaptive step is short against the run and the shortest contact") {
  const std::string head = "[space]\ndimension = 2\nmin = [-1, -1]\nmax = [1, 1]\n[time]\nend = 50.0\n";
  CHECK(near(model_of(head).time.step, 50 * 1e-3, {.relative = kRoundOff}));
  const TimeControl time = model_of(head + kTwoDiscs).time;
  CHECK(near(time.step, 0.05 * std::numbers::pi * std::sqrt(0.5 / 1e4), {.relative = kRoundOff}));
  CHECK(near(time.max_step, 0.5, {.relative = kRoundOff}));
  // Discs of radius 0.05 m that fall by 2 m from 5 m/s on: 0.5 x 0.05 / sqrt(5^2 + 2 x 10 x 2).
  CHECK(near(model_of("gravity = [0.0, -10.0]\n" + head + kTwoDiscs, {"particles.0.velocity=[-3.0, 4.0]"})
                 .time.max_step,
             0.025 / std::sqrt(65.0), {.relative = kRoundOff}));
  CHECK(near(model_of("gravity = [0.0, -10.0]\n" + head).time.max_step, 0.5, {.relative = kRoundOff}));
  CHECK(near(time.min_step, 1e-6 * time.step, {.relative = kRoundOff}));
  CHECK(near(model_of(head + kTwoDiscs, {"time.end=1e-2"}).time.step, 1e-5, {.relative = kRoundOff}));
  CHECK(near(model_of(head + kTwoDiscs, {"time.max_step=2e-4"}).time.step, 2e-4, {.relative = kRoundOff}));
  CHECK(
      contains(model_error(head + kTwoDiscs, {"time.min_step=1e-2"}), "must be at most time.step = 0.00111"));
}

TEST_CASE("a particle that goes farther than its radius in a step is a warning") {
  // Two discs of radius 0.05; the substeps count. An impact at such a speed is another warning.
  const auto step_warnings = [](const std::vector<std::string>& overrides) {
    std::vector<std::string> warnings = model_warnings(kDeck, overrides);
    std::erase_if(warnings, [](const std::string& text) { return !text.starts_with("time."); });
    return warnings;
  };
  const std::string verlet = "integrator.particles=velocity-verlet",
                    fast = "particles.0.velocity=[-15.0, 20.0]";
  CHECK(step_warnings({fast, "time.step=1.9e-3"}).empty());
  CHECK(step_warnings({fast, verlet, "integrator.substeps=2", "time.step=3.9e-3"}).empty());
  const std::string rest =
      "0.0025 s a particle moves by 1.25 times its radius with its speed at t = 0, and may pass others "
      "unnoticed; ";
  CHECK(step_warnings({fast, "time.step=2.5e-3"}) ==
        std::vector<std::string>{"time.step: in a step of " + rest + "it should be at most 0.001 s"});
  const std::vector<std::string> in_two =
      step_warnings({fast, verlet, "integrator.substeps=2", "time.step=5e-3"});
  REQUIRE(in_two.size() == 1);
  CHECK(contains(in_two[0], "time.step: in a step of step / substeps = " + rest + "left out, it is "));
  const std::vector<std::string> adaptive =
      step_warnings({fast, "time.control=adaptive", "time.max_step=0.01"});
  REQUIRE(adaptive.size() == 1);
  CHECK(contains(adaptive[0],
                 "time.max_step: in a step of 0.01 s, the longest allowed, a particle moves by 5 times"));
  CHECK(contains(adaptive[0], "unnoticed; left out, it is at most 0.001 s"));
}

TEST_CASE("an explicit step past the stability limit is an error") {
  // 2 / sqrt(6 K/m) = 8.165e-3 s.
  const std::string verlet = "integrator.particles=velocity-verlet";
  CHECK(near(pair_limits(model_of(kDeck))[0].explicit_step, 2 / std::sqrt(6e4), {.relative = kRoundOff}));
  CHECK(model_error(kDeck, {verlet, "time.step=8e-3"}).empty());
  const std::string message = model_error(kDeck, {verlet, "time.step=8.3e-3"});
  CHECK(contains(message,
                 "--set time.step=8.3e-3: a velocity-verlet step of step / substeps = 0.0083 s is unstable"));
  CHECK(contains(message, "it must be at most 0.008165 s"));
  CHECK(model_error(kDeck, {verlet, "time.step=8.3e-3", "integrator.substeps=2"}).empty());
}

TEST_CASE("exponents other than 1 are estimated at an overlap of 1 % of the radius") {
  const std::string exponent = "contact.pairs.0.exponent=1.5";
  const std::vector<PairLimit> limits = pair_limits(model_of(kDeck, {exponent}));
  CHECK(near(limits[0].stiffness, 1e4 * 1.5 * std::sqrt(0.01 * 0.05), {.relative = kRoundOff}));
  const std::vector<std::string> warnings =
      model_warnings(kDeck, {exponent, "integrator.particles=velocity-verlet", "time.step=0.1"});
  REQUIRE(warnings.size() == 1);
  CHECK(contains(warnings[0], "unstable"));
}

TEST_CASE("beside explicit particles the bodies' step must be short against their oscillation on a contact") {
  // sqrt(K / m) = 1e3 / s for n = 1; for n = 1.5 at an overlap of 0.5 mm: an error and a warning.
  const std::string deck =
      kDeck + "[[bodies]]\nname = \"ram\"\nposition = [-0.5, 0.5]\nmass = 0.01\ninertia = 1e-5\n" +
      "shapes = [{ radius = 0.05 }]\n";
  const auto with_step = [](const std::string& step) {
    return std::vector<std::string>{"integrator.particles=velocity-verlet", "time.step=" + step,
                                    "contact.pairs.0.exponent=1.0"};
  };
  CHECK(model_error(deck, with_step("6.9e-4")).empty());
  CHECK(contains(
      model_error(deck, with_step("7.1e-4")),
      "a body on a contact oscillates with 1000 rad/s; with velocity-verlet particles the bodies' step "
      "must be at most 0.0007 s"));
  // Two bodies with contacts between each other alone, and the reduced mass of half of one.
  const std::string two = deck + "[[bodies]]\nname = \"other\"\nposition = [-0.5, 0.2]\nmass = 0.01\n" +
                          "inertia = 1e-5\nshapes = [{ radius = 0.05 }]\n";
  const auto alone = [&](const std::string& step) {
    std::vector<std::string> settings = with_step(step);
    settings.emplace_back("particles=[]");
    return model_error(two, settings);
  };
  CHECK(alone("1.4e-3").empty());
  CHECK(contains(alone("1.5e-3"),
                 "a body on a contact oscillates with 1414 rad/s; with velocity-verlet "
                 "particles the bodies' step must be at most 0.00141 s"));
  const std::vector<std::string> warnings =
      model_warnings(deck, {"integrator.particles=velocity-verlet", "time.step=6e-3",
                            "contact.pairs.0.exponent=1.5", "contact.pairs.0.stiffness=1e5"});
  const Real frequency = std::sqrt(1e5 * 1.5 * std::sqrt(5e-4) / 0.01);
  REQUIRE(!warnings.empty());
  CHECK(contains(warnings[0], fmt::format("oscillates with {:.4g} rad/s", frequency)));
}

TEST_CASE("a particle may start periods outside a periodic domain, unless its position loses digits") {
  const std::string deck = kSmallDeck +
                           "[[contact.pairs]]\nstiffness = 1e4\n[[particles]]\nkind = \"list\"\n" +
                           "radius = 0.05\nmass = 1.0\npositions = [[0, 0]]\n";
  const auto error = [&](const std::string& x) {
    return model_error(
        deck, {"space.x_min=periodic", "space.x_max=periodic", "particles.0.positions=[[" + x + ", 0]]"});
  };
  CHECK(error("1e5").empty());
  CHECK(contains(error("1e9"), "particle 0 starts at (1000000000, 0), outside the space"));
  CHECK(contains(error("-1e300"), "particle 0 starts at (-1e+300, 0), outside the space"));
}

}  // namespace scree
