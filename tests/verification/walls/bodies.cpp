// Bodies' shapes on moving walls and conveyors.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "verification/walls/wall_decks.hpp"

namespace scree {

namespace {

constexpr Real kMass = 1, kRadius = 0.1, kStiffness = 1e5, kGravity = 9.81;

// A sphere of a body at this height [m].
Model model_with(const std::string& wall, const std::string& method, Real height, Real gravity, Real end,
                 const std::string& law) {
  return model_of(fmt::format(
      "gravity = [0, 0, -{}]\n[space]\ndimension = 3\nmin = [-4, -4, -1]\nmax = [4, 4, 2]\n[time]\nend = "
      "{}\nstep = 1e-4\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\n[[contact.pairs]]\nstiffness "
      "= "
      "{}\n{}[[walls]]\nname = \"plate\"\n{}{}[[bodies]]\nname = \"ball\"\nkind = \"spatial\"\nposition = "
      "[0, "
      "0, {}]\nmass = {}\ninertia_tensor = [{}, {}, {}, 0, 0, 0]\nshapes = [{{ radius = {} }}]\n",
      gravity, end, method, kStiffness, law, kFloor, wall, height, kMass, 0.4 * kMass * kRadius * kRadius,
      0.4 * kMass * kRadius * kRadius, 0.4 * kMass * kRadius * kRadius, kRadius));
}

}  // namespace

// The belt does a little more than twice the work that the sphere keeps.
TEST_CASE("a belt takes a body's sphere along with 2/7 of its speed, and the ledger has its work") {
  constexpr Real kSpeed = 2;
  for (const std::string method : {"velocity-verlet", "hht"}) {
    CAPTURE(method);
    SimulationRun run(model_with(fmt::format("surface_velocity = [{}, 0, 0]\n", kSpeed), method,
                                 kRadius - kMass * kGravity / kStiffness, kGravity, 0.6,
                                 "restitution = 0.5\nfriction = 0.4\ntangential_damping_ratio = 0.3\n"));
    run.run();
    const BodyMotion ball = run.multibody().motion(run.bodies())[0];
    CHECK(near(ball.velocity.x, 2 * kSpeed / 7, {.relative = 1e-9}));
    CHECK(near(global_spin(ball).y, -5 * kSpeed / 7 / kRadius, {.relative = 1e-9}));
    CHECK(near(run.ledger().driver_work, kMass * 2 * kSpeed / 7 * kSpeed, {.relative = 1e-3}));
    CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-3, .measured = 3e-4}));
  }
}

TEST_CASE("a wall that moves strikes a body's sphere, which leaves with twice its speed") {
  for (const std::string method : {"velocity-verlet", "hht"}) {
    CAPTURE(method);
    SimulationRun run(model_with(motions("{ type = \"translation\", direction = [0, 0, 1], displacement = { "
                                         "kind = \"ramp\", rate = 1 } }"),
                                 method, kRadius + 0.001, 0, 0.02, ""));
    run.run();
    CHECK(run.particle_ledger().contacts == 0);
    CHECK(near(run.multibody().motion(run.bodies())[0].velocity, {0, 0, 2}, {.relative = 2e-3}));
    CHECK(near(run.ledger().driver_work, kMass * 2, {.relative = 4e-3}));
  }
}

}  // namespace scree
