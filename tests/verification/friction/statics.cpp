// Equilibria by friction alone: piles, a sphere between two walls, a column of spheres, an undisturbed heap.
#include <cmath>
#include <numbers>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 0.05;  // [m]

// Bodies of 1 kg on a floor with its own friction, in touch; damped well below their first oscillation.
std::string pile_deck(int dimension, const std::string& positions, Real friction, Real floor_friction) {
  const std::string zero = dimension == 2 ? "" : ", 0.0", far = dimension == 2 ? "" : ", 1.0";
  return fmt::format(R"(
gravity = [0.0, -9.81{zero}]
[space]
dimension = {dimension}
min = [-1.0, 0.0{near}]
max = [1.0, 1.0{far}]
y_min = "wall"
wall_material = "floor"
[time]
end = 0.6
step = 5e-5
[integrator]
particles = "velocity-verlet"
[[materials]]
name = "body"
[[materials]]
name = "floor"
[[contact.pairs]]
materials = ["body", "body"]
stiffness = 1e6
damping = 500.0
friction = {friction}
tangential_damping_ratio = 0.5
[[contact.pairs]]
materials = ["body", "floor"]
stiffness = 1e6
damping = 500.0
friction = {floor_friction}
tangential_damping_ratio = 0.5
[[particles]]
name = "pile"
kind = "list"
positions = {positions}
radius = {radius}
mass = 1.0
material = "body"
)",
                     fmt::arg("zero", zero), fmt::arg("dimension", dimension),
                     fmt::arg("near", dimension == 2 ? "" : ", -1.0"), fmt::arg("far", far),
                     fmt::arg("friction", friction), fmt::arg("floor_friction", floor_friction),
                     fmt::arg("positions", positions), fmt::arg("radius", kRadius));
}

// One sphere on several that touch each other, each at an angle phi from the vertical.
std::string pile_positions(int lower, Real phi) {
  std::string out = "[";
  const Real reach = 2 * kRadius * std::sin(phi);
  for (int k = 0; k < lower; ++k) {
    const Real angle = 2 * std::numbers::pi_v<Real> * k / lower;
    out += fmt::format("[{}, {}{}], ", reach * std::cos(angle), kRadius,
                       lower == 2 ? "" : fmt::format(", {}", reach * std::sin(angle)));
  }
  return out + fmt::format("[0.0, {}{}]]", kRadius * (1 + 2 * std::cos(phi)), lower == 2 ? "" : ", 0.0");
}

// Descent of the upper sphere, in radii.
Real sunk(int lower, Real phi, Real friction, Real floor_friction,
          const std::vector<std::string>& settings = {}) {
  SimulationRun run(model_of(
      pile_deck(lower == 2 ? 2 : 3, pile_positions(lower, phi), friction, floor_friction), settings));
  run.run();
  return 1 + 2 * std::cos(phi) - run.particles().back().position.y / kRadius;
}

}  // namespace

// Implicit steps are as long as the fastest contact.
TEST_CASE("the smallest piles stand above their limits of friction, and not below") {
  const ReferenceTable table("contact/piles.csv");
  constexpr Real kMargin =
      0.05;  // relative to the limits; soft contacts shift them by the overlap over the radius
  std::vector<std::string> settings;
  SECTION("in explicit steps") {}
  SECTION("in implicit steps") {
    settings = implicit_steps(-0.05);
    settings.emplace_back("time.step=1e-3");
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& row = table.rows().at(k);
    const int lower = static_cast<int>(k) + 2;
    const Real phi = row["phi_deg"] * std::numbers::pi_v<Real> / 180;
    const Real upper = row["mu_upper"], floor = row["mu_floor"];
    CAPTURE(lower);
    CHECK(keeps(sunk(lower, phi, (1 + kMargin) * upper, (1 + kMargin) * floor, settings),
                {.promise = 1e-2, .measured = 7e-4}));
    CHECK(sunk(lower, phi, (1 - kMargin) * upper, 2 * floor, settings) > 0.05);
    CHECK(sunk(lower, phi, 2 * upper, (1 - kMargin) * floor, settings) > 0.05);
  }
}

TEST_CASE("a sphere between two walls is held by friction, swinging, or falls") {
  const ReferenceTable table("contact/held_by_friction.csv");
  const auto& row = table.rows().at(0);
  const Real R = row["R"], period = row["period"];
  const auto deck = [&](Real friction, Real step) {
    return fmt::format(R"(
gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [-{half}, -1.0, -1.0]
max = [{half}, 1.0, 1.0]
x_min = "wall"
x_max = "wall"
[time]
end = {end}
step = {step}
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = {kn}
friction = {friction}
tangential_stiffness = {kt}
[[particles]]
name = "held"
kind = "list"
positions = [[0.0, 0.0, 0.0]]
radius = {R}
mass = {m}
)",
                       fmt::arg("half", R - row["d"]), fmt::arg("end", 8 * period), fmt::arg("step", step),
                       fmt::arg("kn", row["kn"]), fmt::arg("friction", friction), fmt::arg("kt", row["kt"]),
                       fmt::arg("R", R), fmt::arg("m", row["m"]));
  };
  // Dropped suddenly it needs twice the friction that holds it statically.
  SECTION("held: it swings about its sag without turning, to second order") {
    const auto errors_at = [&](Real parts) {
      Errors errors;
      const Real h = period / parts;
      SimulationRun run(model_of(deck(2.1 * row["mu_min"], h)));
      for (int k = 1; k <= 60; ++k) {
        run.run_until(k * period / 8 - h / 2);
        const Real swing = row["sag"] * (std::cos(2 * std::numbers::pi_v<Real> * run.time() / period) - 1);
        errors.add((run.particles()[0].position.z - swing) / row["lowest"]);
        CHECK(run.particles()[0].angular_velocity == Vec3{});
      }
      CHECK(std::abs(run.particle_ledger().contact_loss) < 1e-20);  // of some 1e-8 J
      return errors;
    };
    const Errors coarse = errors_at(80), fine = errors_at(160);
    CHECK(keeps(coarse.worst(), {.promise = 5e-2, .measured = 5.9e-3}));
    CHECK(keeps(fine.worst(), {.promise = 2e-2, .measured = 1.5e-3}));
    CHECK(order_between(coarse, fine) > 1.9);
  }
  SECTION("too slick: it falls with what friction leaves of its weight") {
    const Real share = 0.5;
    SimulationRun run(model_of(deck(share * row["mu_min"], period / 200)));
    run.run();
    const Real expected = -(1 - share) * Real(9.81) * run.time();
    CHECK(keeps(run.particles()[0].velocity.z / expected - 1, {.promise = 5e-2, .measured = 1.4e-2}));
  }
}

TEST_CASE("a column of spheres in zigzag between two walls comes to the rest of its springs") {
  const ReferenceTable spheres("contact/zigzag_spheres.csv");
  std::vector<std::string> settings;
  SECTION("in explicit steps") {}
  SECTION("in implicit steps") {
    settings = implicit_steps(-0.05);
    settings.insert(settings.end(), {"time.step=1e-4", "integrator.residual_tolerance=1e-11",
                                     "integrator.correction_tolerance=1e-11"});
  }
  constexpr Real R = 0.01, m = 0.01, kRise = 0.714142842854285;
  std::string positions = "[";
  for (int i = 0; i < 6; ++i)
    positions += fmt::format("[{}, 0.0, {}], ", i % 2 == 0 ? R : 0.034 - R, R + 2 * R * kRise * i);
  SimulationRun run(model_of(fmt::format(R"(
gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [1e-6, -0.05, 0.0]
max = [0.033999, 0.05, 0.2]
x_min = "wall"
x_max = "wall"
z_min = "wall"
[time]
end = 0.25
step = 2e-6
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e6
damping = 60.0
friction = 10.0
tangential_stiffness = 8e5
tangential_damping_ratio = 0.3
[[particles]]
name = "column"
kind = "list"
positions = {}]
radius = {}
mass = {}
[output]
history_contacts = ["x_min", "x_max", "z_min"]
)",
                                         positions, R, m),
                             settings));
  run.run();
  const std::vector<Particle> after = run.particles();
  Errors start_positions, turns;
  for (const auto& row : spheres.rows()) {
    const auto i = static_cast<std::size_t>(row["i"]);
    const Vec3 start{i % 2 == 0 ? R : Real(0.034) - R, 0, R + 2 * R * kRise * static_cast<Real>(i)};
    const Vec3 moved = after[i].position - start;
    start_positions.add((moved.x - row["dx"]) / 1e-6), start_positions.add((moved.z - row["dz"]) / 1e-6);
    const Quaternion& q = after[i].orientation;
    turns.add((2 * q.y - row["theta"]) / 1e-4);
  }
  CHECK(keeps(start_positions.worst(), {.promise = 1e-3, .measured = 1e-8}));
  CHECK(keeps(turns.worst(), {.promise = 1e-3, .measured = 2.6e-7}));
  CHECK(run.particle_ledger().kinetic < 1e-24);  // of some 1e-6 J
  // Forces on the walls, opposite to those on the spheres; both in the sums over a wall's contacts.
  const ReferenceTable contacts("contact/zigzag_contacts.csv");
  Vec3 expected[3] = {};
  for (const auto& row : contacts.rows()) {
    const bool right = std::fmod(row["i"], 2) == 1;
    if (row.word("contact") == "wall")
      expected[right ? 1 : 0] += Vec3{right ? row["N"] : -row["N"], 0, -row["Tz"]};
    if (row.word("contact") == "floor") expected[2] += Vec3{-row["Tx"], 0, -row["N"]};
  }
  const std::vector<Real> values = run.contact_values();
  for (std::size_t w = 0; w < 3; ++w)
    CHECK(near(Vec3{values[7 * w], values[7 * w + 1], values[7 * w + 2]}, expected[w], {.relative = 1e-6}));
}

}  // namespace scree
