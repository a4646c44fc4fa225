// Surfaces with cohesion, through decks: on a wall and between two spheres, with and without friction.
#include "physics/cohesion.hpp"

#include <regex>
#include <utility>

#include "physics/restitution.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "support/restitution.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

using Row = ReferenceTable::Row;

// Approximate duration of the impact without cohesion [s].
Real impact_time(const Row& row) { return 3 * row["d_max"] / row["v"]; }

// An impact of a sphere on a wall, or of two spheres of twice its radius and mass, one of them at rest.
GrainDeck impact_deck_of(const Row& row, const std::string& more, Real parts, bool pair) {
  const Real h = impact_time(row) / parts, v = row["v"], R = row["R_star"], m = row["m_star"];
  GrainDeck deck{.law = fmt::format("work_of_adhesion = {}\n", row["w"]) + more,
                 .grains = {},
                 .step = h,
                 .end = 6 * impact_time(row)};
  deck.materials = hertz_materials((pair ? 2 : 1) * row["E_star"], 0), deck.plane = !pair;
  const Real gap = 0.5 * v * h;
  if (pair) {
    deck.grains.push_back(
        {.position = {0, 0, 0}, .velocity = {}, .spin = {}, .radius = 2 * R, .mass = 2 * m});
    deck.grains.push_back({.position = {0, 0, 4 * R + gap},
                           .velocity = {0, 0, -v},
                           .spin = {},
                           .radius = 2 * R,
                           .mass = 2 * m});
  } else {
    deck.grains.push_back(
        {.position = {0, 0, R + gap}, .velocity = {0, 0, -v}, .spin = {}, .radius = R, .mass = m});
  }
  return deck;
}

// Without friction of any pair a deck must not give spins.
Model model_without_spins(const GrainDeck& deck) {
  return model_of(std::regex_replace(deck.text(), std::regex("angular_velocity = .*\n"), ""));
}

struct ImpactErrors {
  Errors energy;   // of the rebound, relative to the impact
  Errors balance;  // relative to the impact's energy
};

void add_impact(const Row& row, const std::string& more, Real parts, bool pair, ImpactErrors& errors) {
  std::string law = more;
  if (row["z"] > 0) law += fmt::format("restitution = {}\n", restitution_of(row["z"], true));
  SimulationRun run(impact_deck_of(row, law, parts, pair).model());
  run.run();
  const std::vector<Particle> after = run.particles();
  const Real rate = after.back().velocity.z - (pair ? after.front().velocity.z : 0);
  const bool holds = run.particle_ledger().contacts > 0;
  CHECK(holds == (row["e"] == 0));
  const Real rebound = holds ? 0 : rate / row["v"], start = row["m_star"] * row["v"] * row["v"] / 2;
  errors.energy.add(rebound * rebound - row["e"] * row["e"]);
  errors.balance.add(run.balance_error() / start);
}

ImpactErrors jkr_errors(const std::string& more, Real parts, bool pair) {
  const ReferenceTable table("contact/jkr_impact.csv");
  ImpactErrors errors;
  for (const auto& row : table.rows()) {
    CAPTURE(row.word("set"), row["z"], row["v"], pair);
    add_impact(row, more, parts, pair, errors);
  }
  return errors;
}

}  // namespace

TEST_CASE("spheres with JKR contacts rebound from a wall and from each other, or stick") {
  for (const bool pair : {false, true})
    for (const std::string more : {"", "friction = 0.5\nrolling_friction = 0.1\n"}) {
      const ImpactErrors coarse = jkr_errors(more, 200, pair), fine = jkr_errors(more, 400, pair);
      CHECK(keeps(coarse.energy.worst(), {.promise = 2e-2, .measured = 3.1e-3}));
      CHECK(keeps(fine.energy.worst(), {.promise = 1e-2, .measured = 1.1e-3}));
      CHECK(keeps(fine.balance.worst(), {.promise = 1e-2, .measured = 1.6e-3}));
      CHECK(order_between(coarse.energy, fine.energy) > 0.9);
    }
}

// Dissipation of formation and breaking of a JKR contact: 7.0922 (w^5 R*^4 / E*^2)^(1/3), whatever the path.
TEST_CASE(
    "the ledger has the formation dissipation of JKR contacts, and their energy is negative while they "
    "last") {
  const ReferenceTable table("contact/jkr_points.csv");
  for (const auto& row : table.rows()) {
    const Real v = 2 * row["v_stick"], R = row["R_star"], h = std::abs(row["d_sep"]) / v / 50;
    GrainDeck deck{.law = fmt::format("surface_energy = {}\n", row["w"] / 2),
                   .grains = {{.position = {0, 0, R + h * v / 2},
                               .velocity = {0, 0, -v},
                               .spin = {},
                               .radius = R,
                               .mass = row["m_star"]}},
                   .step = h,
                   .end = 60 * std::abs(row["d_sep"]) / v};
    deck.materials = hertz_materials(row["E_star"], 0);
    SimulationRun run(deck.model());
    run.step();
    CHECK(run.particle_ledger().contacts == 1);
    CHECK(near(run.particle_ledger().contact_loss, row["W_stick"], {.relative = 1e-2}));
    CHECK(near(run.particle_ledger().contact_elastic, -row["W_stick"], {.relative = 0.1}));
    run.run();
    CHECK(run.particle_ledger().contacts == 0);
    CHECK(run.particle_ledger().contact_elastic == 0);
    const Real left = row["m_star"] / 2 * (v * v - std::pow(run.particles()[0].velocity.z, 2));
    CHECK(near(left, row["W_stick"], {.relative = 1e-2}));
  }
}

// On a wall and between two spheres, with sliding and spins; the energy of the springs stays in the balance.
TEST_CASE("a JKR contact that breaks dissipates the energy of its springs") {
  const ReferenceTable table("contact/jkr_impact.csv");
  const auto& row = table.rows()[2];
  REQUIRE((row["z"] == 0 && row["e"] > 0.8));
  const auto balance_at = [&](Real parts, bool pair) {
    GrainDeck deck =
        impact_deck_of(row, "friction = 0.4\nrolling_friction = 0.2\ntwisting_friction = 0.3\n", parts, pair);
    Grain& grain = deck.grains.back();
    grain.velocity.x = row["v"] / 2, grain.spin = (row["v"] / grain.radius) * Vec3{0.5, 0.3, 1};
    SimulationRun run(deck.model());
    Real held = 0;  // energy of the springs when the JKR contact last existed
    while (run.time() < deck.end * 0.99) {
      run.step();
      const ParticleLedger ledger = run.particle_ledger();
      if (ledger.contacts == 0 && held > 0) break;
      held = ledger.rotation.friction_springs + ledger.rotation.rolling_springs;
    }
    REQUIRE(run.particle_ledger().contacts == 0);
    run.run();
    return std::pair{run.balance_error() / run.exchanged(), held / run.exchanged()};
  };
  for (const bool pair : {false, true}) {
    CAPTURE(pair);
    const auto [coarse, held] = balance_at(500, pair);
    const auto [fine, held_too] = balance_at(2000, pair);
    CHECK(held > 1e-3);
    CHECK(std::abs(fine) < held_too / 20);
    CHECK(keeps(coarse, {.promise = 1e-3, .measured = 3.4e-4}));
    CHECK(std::abs(fine) < 0.7 * std::abs(coarse));
  }
}

TEST_CASE("a JKR contact that exists at the start has its full energy") {
  const ReferenceTable table("contact/jkr_points.csv");
  const auto& row = table.rows()[0];
  const Real R = row["R_star"], period = 1e-2 * row["d_F0"] / row["v_stick"];
  GrainDeck deck{.law = fmt::format("work_of_adhesion = {}\n", row["w"]),
                 .grains = {{.position = {0, 0, R - 1.1 * row["d_F0"]},
                             .velocity = {},
                             .spin = {},
                             .radius = R,
                             .mass = row["m_star"]}},
                 .step = period,
                 .end = 1000 * period};
  deck.materials = hertz_materials(row["E_star"], 0);
  SimulationRun run(deck.model());
  run.run();
  CHECK(run.particle_ledger().contacts == 1);
  CHECK(std::abs(run.balance_error()) < 1e-3 * row["W_stick"]);
}

// Two spheres at rest, or one and a wall, before any step.
TEST_CASE("the ledger has the cohesive part of the elastic energy, in touch and beyond") {
  constexpr Real R = 0.01, pull = 1, range = 1e-3, stiffness = 1e5;
  for (const std::string more : {"", "friction = 0.5\n"})
    for (const bool pair : {false, true})
      for (const Real overlap : {2e-4, -3e-4}) {
        CAPTURE(more, pair, overlap);
        GrainDeck deck{.law = fmt::format("stiffness = {}\nattraction = {}\nattraction_range = {}\n",
                                          stiffness, pull, range) +
                              more,
                       .grains = {},
                       .step = 1e-5,
                       .end = 1e-3};
        deck.plane = !pair;
        deck.grains.push_back({.position = {0, 0, R - (pair ? R : overlap)}, .radius = R, .mass = 0.1});
        if (pair) deck.grains.push_back({.position = {0, 0, 2 * R - overlap}, .radius = R, .mass = 0.1});
        SimulationRun run(model_without_spins(deck));
        const ParticleLedger ledger = run.particle_ledger();
        const Real beyond = std::min(overlap, Real(0)) + range, touching = std::max(overlap, Real(0));
        CHECK(near(ledger.cohesion, -pull * (beyond * beyond / (2 * range) + touching), {.relative = 1e-9}));
        CHECK(near(ledger.contact_elastic - ledger.cohesion, stiffness / 2 * touching * touching,
                   {.relative = 1e-9, .absolute = 1e-15}));
      }
}

TEST_CASE("the energy of a JKR contact beyond Hertz's energy of its overlap is cohesion") {
  const ReferenceTable table("contact/jkr_points.csv");
  const auto& row = table.rows()[0];
  const Real R = row["R_star"], step = 1e-3 * row["d_F0"] / row["v_stick"];
  const auto hertz = [&](Real d) {
    return d > 0 ? Real(8) / 15 * row["E_star"] * std::sqrt(R) * std::pow(d, 2.5) : 0;
  };
  GrainDeck deck{.law = fmt::format("work_of_adhesion = {}\nfriction = 0.5\n", row["w"]),
                 .grains = {{.position = {0, 0, R - 2.2 * row["d_F0"]},
                             .velocity = {0.1 * row["v_stick"], 0, 0},
                             .spin = {},
                             .radius = R,
                             .mass = row["m_star"]}},
                 .step = step,
                 .end = 4000 * step};
  deck.materials = hertz_materials(row["E_star"], 0);
  SimulationRun run(deck.model());
  Real lowest = 0, thinnest = R;
  while (run.time() < deck.end * 0.99) {
    for (int k = 0; k < 50; ++k) run.step();
    const ParticleLedger ledger = run.particle_ledger();
    const Real d = R - run.particles()[0].position.z;
    const Real rest = ledger.contact_elastic - ledger.rotation.friction_springs -
                      ledger.rotation.rolling_springs - ledger.cohesion;
    CHECK(near(rest, hertz(d), {.relative = 1e-9, .absolute = 1e-9 * row["W_stick"]}));
    CHECK(ledger.cohesion < 0);
    lowest = std::min(lowest, ledger.cohesion), thinnest = std::min(thinnest, d);
  }
  CHECK(thinnest < 0);  // it is stretched beyond touch, and holds
  CHECK(lowest < -1.5 * row["W_stick"]);
}

TEST_CASE("DMT: spheres rebound without loss, and rest where the spring carries the attraction") {
  const ReferenceTable table("contact/dmt.csv");
  for (const auto& row : table.rows())
    for (const std::string more : {"", "friction = 0.5\n"}) {
      SimulationRun run(model_without_spins(impact_deck_of(row, "adhesion = \"dmt\"\n" + more, 400, true)));
      run.run();
      const std::vector<Particle> after = run.particles();
      const Real rate = (after[1].velocity.z - after[0].velocity.z) / row["v"];
      CHECK(keeps(rate * rate - 1, {.promise = 5e-2, .measured = 1.3e-2}));
    }
}

// At steps of a sixtieth and of a third of the impact's duration without adhesion, approximately.
TEST_CASE("DMT and an attraction in implicit steps: rebound without loss, energy balance, rest") {
  const ReferenceTable table("contact/dmt.csv");
  for (const auto& row : table.rows())
    for (const std::string more : {"", "friction = 0.5\n", "friction = 0.5\nrolling_friction = 0.1\n"})
      for (const Real parts : {60.0, 3.0}) {
        CAPTURE(more, parts);
        GrainDeck deck = impact_deck_of(row, "adhesion = \"dmt\"\n" + more, parts, true);
        deck.settings = implicit_steps(0);
        SimulationRun run(model_of(std::regex_replace(deck.text(), std::regex("angular_velocity = .*\n"), ""),
                                   deck.settings));
        run.run();
        const std::vector<Particle> after = run.particles();
        const Real rate = (after[1].velocity.z - after[0].velocity.z) / row["v"];
        CHECK(run.particle_ledger().contacts == 0);
        CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-9, .measured = 1e-13}));
        CHECK(keeps(rate * rate - 1,
                    {.promise = parts > 10 ? 2e-3 : 0.3, .measured = parts > 10 ? 6.6e-5 : 0.065}));
      }
  // A sphere that hangs from a wall by an attraction of twice its weight.
  constexpr Real R = 0.01, mass = 0.01, g = 9.81, stiffness = 1e4;
  for (const std::string more : {"", "friction = 0.5\n"}) {
    GrainDeck deck{
        .law = fmt::format("stiffness = {}\nattraction = {}\nrestitution = 0.5\n", stiffness, 2 * mass * g) +
               more,
        .grains = {{.position = {0, 0, R - 1e-9}, .radius = R, .mass = mass}},
        .step = 2e-4,
        .end = 0.5};
    deck.gravity = {0, 0, g}, deck.settings = implicit_steps(-0.05);
    SimulationRun run(
        model_of(std::regex_replace(deck.text(), std::regex("angular_velocity = .*\n"), ""), deck.settings));
    run.run();
    CHECK(near(R - run.particles()[0].position.z, mass * g / stiffness, {.relative = 1e-6}));
  }
}

TEST_CASE("an attraction with a range holds two separated spheres, up to its energy") {
  // A = 1 N over 1 mm: 0.5 mJ beyond touch; two spheres of 0.1 kg, m* = 0.05 kg.
  const Real R = 0.01, escape = std::sqrt(2 * 0.5e-3 / 0.05);
  for (const std::string more : {"", "friction = 0.5\n"})
    for (const Real speed : {0.9 * escape, 1.1 * escape}) {
      GrainDeck deck{.law = "stiffness = 1e5\nattraction = 1.0\nattraction_range = 1e-3\n" + more,
                     .grains = {},
                     .step = 1e-5,
                     .end = 0.05};
      deck.plane = false;
      deck.grains.push_back({.position = {0, 0, 0}, .velocity = {}, .spin = {}, .radius = R, .mass = 0.1});
      deck.grains.push_back(
          {.position = {0, 0, 2 * R}, .velocity = {0, 0, speed}, .spin = {}, .radius = R, .mass = 0.1});
      SimulationRun run(model_without_spins(deck));
      run.run();
      CHECK((run.particle_ledger().contacts == 1) == (speed < escape));
      CHECK(std::abs(run.balance_error()) < 1e-2 * run.exchanged());
      if (speed < escape) continue;
      const std::vector<Particle> after = run.particles();
      const Real rate = after[1].velocity.z - after[0].velocity.z;
      CHECK(near(rate * rate, speed * speed - escape * escape, {.relative = 2e-2}));
    }
}

TEST_CASE("friction of a contact under tension holds up to mu times its load and twice the pull-off force") {
  // A sphere that hangs from a wall by JKR adhesion, pulled along it by gravity: JKR's limit is mu (F + 2
  // F_c).
  const ReferenceTable table("contact/jkr_points.csv");
  const auto& row = table.rows()[0];
  const Real R = row["R_star"], Fc = row["Fc"], m = row["m_star"], mu = 0.5;
  for (const Real share : {0.75, 1.1}) {
    const Real g = share * mu * 2 * Fc / m;
    GrainDeck deck{
        .law = fmt::format("work_of_adhesion = {}\nfriction = {}\nrestitution = 0.1\n"
                           "tangential_damping_ratio = 0.5\ntwisting_friction = 0.0\n"
                           "rolling_friction = 20.0\nrolling_damping_ratio = 1.0\n",
                           row["w"], mu),
        .grains = {{.position = {0, 0, R - row["d_F0"]}, .velocity = {}, .spin = {}, .radius = R, .mass = m}},
        .step = 1e-8,
        .end = 4e-5};
    deck.materials = hertz_materials(row["E_star"], 0), deck.gravity = {g, 0, 0};
    SimulationRun run(deck.model());
    run.run();
    const Real fallen = g * deck.end * deck.end / 2;
    CHECK((run.particles()[0].position.x < 0.03 * fallen) == (share < 1));
  }
}

}  // namespace scree
