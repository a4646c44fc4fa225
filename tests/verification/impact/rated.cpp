// Restitution as a deck's key: impacts on a wall against closed forms, for any exponent, with and without
// clipping, with both integrators; also two particles of different masses.
#include <fmt/format.h>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/reference_table.hpp"
#include "support/simulation_run.hpp"
#include "verification/contact/errors.hpp"

namespace scree {

namespace {

using Row = ReferenceTable::Row;

Model impact_on_wall(const Row& row, Real parts, const std::string& integrator) {
  const Real h = row["force_time"] / parts, v = row["v"];
  return model_of(fmt::format(R"(
[space]
dimension = 3
min = [-4.0, -4.0, 0.0]
max = [4.0, 4.0, 8.0]
z_min = "wall"
[time]
end = {}
step = {}
control = "fixed"
[integrator]
particles = "{}"
hht_alpha = 0.0
[[contact.pairs]]
stiffness = {}
exponent = {}
restitution = {}
limit_damping = {}
[[particles]]
name = "ball"
kind = "list"
positions = [[0.0, 0.0, {}]]
velocity = [0.0, 0.0, {}]
radius = 1.0
mass = {}
)",
                              1.2 * row["separation_time"], h, integrator, row["K"], row["n"], row["e"],
                              row.word("variant") != "tension", 1 + 0.3 * h * v, -v, row["m"]));
}

Errors rebound_errors(Real parts, Real exponent, const std::string& integrator) {
  const ReferenceTable table("contact/normal_impact.csv");
  Errors errors;
  for (const Row& row : table.rows()) {
    if (row["n"] != exponent) continue;
    SimulationRun run(impact_on_wall(row, parts, integrator));
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);
    errors.add(run.particles()[0].velocity.z / row["v"] - row["e"]);
  }
  return errors;
}

}  // namespace

TEST_CASE("a restitution beside a stiffness is that of the rebound") {
  struct Case {
    Real exponent;
    const char* integrator;
    Bars bars;
    Real order;
  };
  for (const Case& c : {Case{1, "velocity-verlet", {1e-2, 3.4e-4}, 0.8}, Case{1, "hht", {1e-3, 3.8e-6}, 0.8},
                        Case{1.5, "velocity-verlet", {1e-3, 4.2e-5}, 1}, Case{1.5, "hht", {1e-3, 4.5e-5}, 1},
                        Case{1.25, "velocity-verlet", {1e-3, 9e-5}, 0.9}}) {
    CAPTURE(c.exponent, c.integrator);
    const Errors coarse = rebound_errors(200, c.exponent, c.integrator),
                 fine = rebound_errors(400, c.exponent, c.integrator);
    CHECK(keeps(fine.worst(), c.bars));
    CHECK(order_between(coarse, fine) > c.order);
  }
}

TEST_CASE("partners of any masses rebound with the pair's restitution") {
  for (const Real mass : {0.2, 5.0, 1e4}) {
    const Model model = model_of(fmt::format(R"(
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 0.2
step = 1e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
restitution = 0.6
[[particles]]
name = "light"
kind = "list"
positions = [[-0.11, 0.0]]
velocity = [1.0, 0.0]
radius = 0.1
mass = 0.2
[[particles]]
name = "other"
kind = "list"
positions = [[0.11, 0.0]]
radius = 0.1
mass = {}
)",
                                             mass));
    SimulationRun run(model);
    run.run();
    const std::vector<Particle> after = run.particles();
    CHECK(keeps(after[1].velocity.x - after[0].velocity.x - 0.6, {.promise = 1e-2, .measured = 1.1e-3}));
  }
}

}  // namespace scree
