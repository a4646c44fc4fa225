// Conveyors: surfaces with a tangential velocity.
#include <cmath>
#include <string>
#include <vector>

#include "output/checkpoint.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/state_bits.hpp"
#include "verification/walls/wall_decks.hpp"

namespace scree {

namespace {

constexpr Real kBelt = 0.7, kFriction = 0.2, kGravity = 9.81;
// Comparisons to 1e-9 here sum up the residuals of 4,000 steps; steps that cannot reach a smaller tolerance
// would be halved where round-off decides.
const std::vector<std::string> kSolved{"integrator.residual_tolerance=1e-10"};

// Its weight lies on the belt from the start.
WallDeck conveyor(const std::string& method, Real step) {
  WallDeck deck;
  deck.wall = kFloor + fmt::format("surface_velocity = [{}, 0, 0]\n", kBelt);
  deck.contact = fmt::format(
      "stiffness = 1e5\nfriction = {}\ntangential_stiffness = 1e5\n"
      "tangential_damping_ratio = 0.3\n",
      kFriction);
  deck.gravity = fmt::format("[0, 0, -{}]", kGravity);
  deck.grain = fmt::format("positions = [[-1, 0, {:.17g}]]\n", 0.1 - kGravity / 1e5);
  deck.step = step, deck.end = 0.4, deck.particles = method;
  return deck;
}

// A belt that rotates with its wall as it runs, and shakes.
std::string turntable() {
  return kFloor +
         motions(
             "{ type = \"rotation\", axis = [0, 0, 1], point = [0.5, 0, 0], angle = { kind = \"ramp\", "
             "rate = 3 } }, { type = \"translation\", direction = [0, 0, 1], displacement = { kind = "
             "\"sine\", amplitude = 0.001, frequency = 7 } }") +
         "surface_velocity = [0.5, 0.1, 0]\n";
}

}  // namespace

// It slips for 2/7 B / (mu g). Then it rolls, with 2/7 of the belt's speed; of the belt's work, 2/7 m B^2,
// friction has dissipated half.
TEST_CASE(
    "a sphere laid on a conveyor's belt ends with 2/7 of its speed, rolling; the belt's work is accounted "
    "for") {
  for (const std::string method : {"hht", "velocity-verlet"}) {
    CAPTURE(method);
    SimulationRun run(conveyor(method, 1e-4).model(kSolved));
    run.run();
    const Particle ball = run.particles()[0];
    CHECK(near(ball.velocity.x, 2.0 / 7 * kBelt, {.relative = 1e-3}));
    CHECK(near(ball.velocity.x - 0.1 * ball.angular_velocity.y, kBelt, {.relative = 1e-3}));
    CHECK(near(ball.velocity.z, 0.0, {.absolute = 1e-9}));
    const Ledger ledger = run.ledger();
    CHECK(near(ledger.driver_work, 2.0 / 7 * kBelt * kBelt, {.relative = 2e-3}));
    CHECK(near(ledger.dissipated_contacts, kBelt * kBelt / 7, {.relative = 2e-3}));
    // At the start of explicit steps friction acts at once, but its dissipation counts from the first step
    // on.
    const Real first = Real(0.5) * kFriction * kGravity * kBelt * 1e-4;
    CHECK(std::abs(run.balance_error()) < 1.1 * first);
  }
}

TEST_CASE("a belt that runs is a floor that moves without end") {
  for (const std::string method : {"hht", "velocity-verlet"}) {
    CAPTURE(method);
    WallDeck deck = conveyor(method, 1e-4);
    SimulationRun belt(deck.model(kSolved));
    deck.wall =
        kFloor + motions(fmt::format("{{ type = \"translation\", direction = [1, 0, 0], displacement = "
                                     "{{ kind = \"ramp\", rate = {} }} }}",
                                     kBelt));
    SimulationRun floor(deck.model(kSolved));
    belt.run(), floor.run();
    const Particle a = belt.particles()[0], b = floor.particles()[0];
    CHECK(near(a.position, b.position, {.absolute = 1e-10}));
    CHECK(near(a.angular_velocity, b.angular_velocity, {.absolute = 1e-8}));
    CHECK(near(belt.ledger().driver_work, floor.ledger().driver_work, {.relative = 1e-9}));
    CHECK(near(belt.ledger().dissipated_contacts, floor.ledger().dissipated_contacts, {.relative = 1e-9}));
  }
}

TEST_CASE("a restarted run has the same bits with moving walls and conveyors") {
  for (const std::string method : {"hht", "velocity-verlet"}) {
    CAPTURE(method);
    WallDeck deck = conveyor(method, 1e-4);
    deck.wall = turntable(), deck.end = 0.2;
    deck.grain = "positions = [[0, 0, 0.0999], [0.5, 0.5, 0.1005]]\n";
    const Model model = deck.model({"output.history_interval=0.01"});
    SimulationRun whole(model);
    whole.run();
    SimulationRun first(model);
    first.run_until(0.0813);
    REQUIRE(first.time() < 0.15);
    SimulationRun second(model, first.complete_state());
    second.run();
    CHECK(differing_arrays(pack(whole.complete_state()), pack(second.complete_state())) == "");
    CHECK(std::abs(whole.balance_error()) < (method == "hht" ? 1e-10 : 1e-2) * whole.exchanged());
  }
}

}  // namespace scree
