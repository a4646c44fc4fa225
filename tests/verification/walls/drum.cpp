// A drum that rotates as a wall, and the same drum as a body with a driven joint.
#include <string>

#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/walls/wall_decks.hpp"

namespace scree {

namespace {

const std::string kPipe =
    "[[meshes]]\nname = \"drum\"\nkind = \"pipe\"\nradius = 0.9\ninner_radius = 0.8\nlength = 1\nsegments = "
    "48\nz_axis = [0, 1, 0]\n";
const std::string kDriverMotion = "{ kind = \"step\", end_value = 1.5, start = 0, end = 0.4 }";

// A sphere that lies in the lower part of a pipe about the y axis.
WallDeck in_drum(const std::string& method) {
  WallDeck deck;
  deck.wall =
      "mesh = \"drum\"\n" +
      motions("{ type = \"rotation\", axis = [0, 1, 0], point = [0, 0, 0], angle = " + kDriverMotion + " }");
  deck.contact = "stiffness = 1e4\ndamping = 20\nfriction = 0.5\n", deck.gravity = "[0, 0, -9.81]";
  deck.step = 1e-4, deck.end = 0.4, deck.particles = method;
  deck.grain = "positions = [[0, 0.01, -0.695]]\n", deck.rest = kPipe;
  return deck;
}
WallDeck in_driven_body(const std::string& method) {
  WallDeck deck = in_drum(method);
  deck.wall = "point = [0, 0, -0.99]\nnormal = [0, 0, 1]\n";  // out of range
  deck.rest +=
      "[[bodies]]\nname = \"drum\"\nkind = \"spatial\"\nposition = [0, 0, 0]\nmass = 5\n"
      "inertia_tensor = [1, 1, 1, 0, 0, 0]\nmeshes = [{ mesh = \"drum\" }]\n"
      "[[joints]]\nname = \"axle\"\ntype = \"revolute\"\nbodies = [\"ground\", \"drum\"]\n"
      "point = [0, 0, 0]\naxis = [0, 1, 0]\n"
      "[[drivers]]\nname = \"motor\"\njoint = \"axle\"\nmotion = " +
      kDriverMotion + "\n";
  return deck;
}

}  // namespace

TEST_CASE("a drum rotated as a wall carries a sphere as a driven one, and takes the same work") {
  for (const std::string method : {"hht", "velocity-verlet"}) {
    CAPTURE(method);
    SimulationRun wall(in_drum(method).model()), body(in_driven_body(method).model());
    wall.run(), body.run();
    const Particle a = wall.particles()[0], b = body.particles()[0];
    CHECK(a.position.x < -0.1);  // it was carried up
    CHECK(near(a.position, b.position, {.absolute = 1e-6}));
    CHECK(near(a.angular_velocity, b.angular_velocity, {.absolute = 1e-4}));
    const Ledger driven = body.ledger();
    CHECK(near(wall.ledger().driver_work, driven.driver_work, {.absolute = 1e-3}));
    CHECK(std::abs(wall.balance_error()) < (method == "hht" ? 1e-10 : 2e-3) * wall.exchanged());
  }
}

}  // namespace scree
