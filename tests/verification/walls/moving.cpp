// Walls that follow functions of time, against closed forms, and their work in the energy ledger.
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/walls/wall_decks.hpp"

namespace scree {

namespace {

constexpr Real kMass = 1, kRadius = 0.1, kStiffness = 1e4;
const std::string kElastic = "stiffness = 1e4\n";
const std::vector<std::string> kMethods = {"hht", "velocity-verlet"};

// A floor shaken by A sin(W t) beneath a sphere that lies on it, w^2 = k / m: x = A (sin W t - W/w sin w t)
// / (1 - W^2/w^2).
constexpr Real kAmplitude = 1e-3, kFrequency = 5;
WallDeck shaken(const std::string& method, Real step) {
  WallDeck deck;
  deck.wall =
      kFloor + motions(fmt::format("{{ type = \"translation\", direction = [0, 0, 3], displacement = {{ "
                                   "kind = \"sine\", amplitude = {}, frequency = {} }} }}",
                                   kAmplitude, kFrequency));
  deck.contact = kElastic, deck.gravity = "[0, 0, -40]";
  deck.grain = fmt::format("positions = [[0, 0, {}]]\n", kRadius - kMass * 40 / kStiffness);
  deck.step = step, deck.end = 0.3, deck.particles = method;
  return deck;
}

struct Shaken {
  Real error, balance;  // of the height [m]; of the energy balance relative to the energy exchanged
};
Shaken shake(const std::string& method, Real step) {
  SimulationRun run(shaken(method, step).model());
  run.run();
  const Real w = std::sqrt(kStiffness / kMass), drive = 2 * std::numbers::pi_v<Real> * kFrequency;
  const Real t = run.time(), q = drive / w;
  const Real x = kAmplitude * (std::sin(drive * t) - q * std::sin(w * t)) / (1 - q * q);
  const Real height = kRadius - kMass * 40 / kStiffness + x;
  return {std::abs(run.particles()[0].position.z - height), std::abs(run.balance_error()) / run.exchanged()};
}

// A wall of velocity V hits a resting sphere.
WallDeck piston(const std::string& method, const std::string& wall, const std::string& rest) {
  WallDeck deck;
  deck.wall = wall + motions(
                         "{ type = \"translation\", direction = [0, 0, 1], displacement = { kind = "
                         "\"ramp\", rate = 0.5 } }");
  deck.contact = kElastic, deck.grain = "positions = [[0, 0, 0.11]]\n";
  deck.step = 2e-5, deck.end = 0.1, deck.particles = method, deck.rest = rest;
  return deck;
}

}  // namespace

TEST_CASE(
    "a sphere on a shaken floor follows the closed form at second order, and the floor's work is accounted "
    "for") {
  for (const std::string& method : kMethods) {
    CAPTURE(method);
    const Shaken coarse = shake(method, 4e-4), fine = shake(method, 2e-4);
    CHECK(fine.error < 2e-3 * kAmplitude);
    CHECK(near(std::log2(coarse.error / fine.error), 2, {.absolute = 0.2}));
    CHECK(fine.balance < 1e-5);
    CHECK((coarse.balance < 1e-9 || coarse.balance / fine.balance > 3));
  }
}

TEST_CASE("a piston accelerates a resting sphere to twice its speed, and its work is the sphere's energy") {
  for (const std::string& method : kMethods) {
    CAPTURE(method);
    SimulationRun plane(piston(method, kFloor, "").model());
    plane.run();
    const Particle ball = plane.particles()[0];
    CHECK(near(ball.velocity.z, 1.0, {.relative = 1e-5}));
    CHECK(near(plane.ledger().driver_work, 0.5 * kMass, {.relative = 2e-5}));
    CHECK(std::abs(plane.balance_error()) < 1e-5 * plane.exchanged());

    std::string wall = kPlateWall;  // as a face of a box, which lies 0.25 m lower
    WallDeck deck = piston(method, wall, kPlateMesh);
    deck.grain = "positions = [[0.3, -0.2, 0.36]]\n";
    SimulationRun mesh(deck.model());
    mesh.run();
    CHECK(near(mesh.particles()[0].velocity.z, ball.velocity.z, {.relative = 1e-11}));
    CHECK(near(mesh.particles()[0].position.z, ball.position.z + 0.25, {.absolute = 1e-11}));
  }
}

TEST_CASE("combined motions: a plane and a box that rotate while they translate carry a sphere alike") {
  const std::string path = motions(
      "{ type = \"rotation\", axis = [0, 1, 0], point = [-1, 0, 0], angle = { kind = \"ramp\", rate = "
      "-0.4 } }, { type = \"translation\", direction = [1, 0, 0], displacement = { kind = \"sine\", "
      "amplitude = 0.05, frequency = 2 } }");
  for (const std::string& method : kMethods) {
    CAPTURE(method);
    WallDeck deck;
    deck.contact = "stiffness = 1e4\ndamping = 20\nfriction = 0.5\n";
    deck.gravity = "[0, 0, -9.81]", deck.step = 1e-4, deck.end = 0.5, deck.particles = method;
    deck.wall = "point = [0, 0, 0.25]\nnormal = [0, 0, 1]\n" + path,
    deck.grain = "positions = [[0, 0, 0.35]]\n";
    SimulationRun plane(deck.model());
    deck.wall = kPlateWall + path, deck.rest = kPlateMesh;
    SimulationRun mesh(deck.model());
    plane.run(), mesh.run();
    const Particle a = plane.particles()[0], b = mesh.particles()[0];
    CHECK(a.position.z > 0.4);  // it was lifted
    CHECK(near(b.position, a.position, {.absolute = 1e-10}));
    CHECK(near(b.angular_velocity, a.angular_velocity, {.absolute = 1e-8}));
    CHECK(std::abs(plane.balance_error()) < (method == "hht" ? 1e-10 : 1e-3) * plane.exchanged());
  }
}

}  // namespace scree
