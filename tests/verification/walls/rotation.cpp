// Particles that roll over rotating surfaces: planes, lines and meshes, of walls and of bodies.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 0.012, kMass = 0.05, kStiffness = 2e4, kGravity = 9.81;
constexpr Real kHeight = kRadius - kMass * kGravity / kStiffness;  // height at rest on a horizontal plane
const std::vector<std::string> kMethods = {"hht", "velocity-verlet"};

// One particle on surfaces that carry it along.
struct TurningDeck {
  std::string name;
  int dimension = 3;
  std::string surfaces;  // walls, or bodies and what drives them
  std::string position, velocity, spin;

  std::string text(const std::string& method, Real step, Real end) const {
    const std::string up = dimension == 3 ? "0, 0, " : "0, ", far = dimension == 3 ? "1, 1, 1" : "1, 1",
                      near = dimension == 3 ? "-1, -1, -1" : "-1, -1";
    return fmt::format(
        "gravity = [{}-{}]\n[space]\ndimension = {}\nmin = [{}]\nmax = [{}]\n[time]\nend = {:.17g}\nstep = "
        "{}\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\nhht_alpha = -0.02\nresidual_tolerance = "
        "1e-11\n[[contact.pairs]]\nstiffness = {}\ndamping = 20\nfriction = 1\ntangential_stiffness = "
        "1e4\ntangential_damping_ratio = 0.3\n{}[[particles]]\nname = \"ball\"\nkind = \"list\"\nradius = "
        "{}\nmass = {}\npositions = [[{}]]\nvelocity = [{}]\nangular_velocity = [{}]\n",
        up, kGravity, dimension, near, far, end, step, method, kStiffness, surfaces, kRadius, kMass, position,
        velocity, spin);
  }
};

std::string wall(const std::string& surface, const std::string& axis, const std::string& angle) {
  const std::string about = axis.empty() ? "point = [0, 0]" : "point = [0, 0, 0], axis = [" + axis + "]";
  return "[[walls]]\nname = \"table\"\n" + surface + "motions = [{ type = \"rotation\", " + about +
         ", angle = " + angle + " }]\n";
}
// The wall's motion as that of a heavy body, by a driver.
std::string body(const std::string& axis, const std::string& angle, const std::string& spin) {
  const std::string in_space =
                        "kind = \"spatial\"\nposition = [0, 0, 0]\ninertia_tensor = [5, 5, 9, 0, 0, "
                        "0]\n" +
                        spin,
                    in_plane = "position = [0, 0]\ninertia = 5\n";
  return "[[bodies]]\nname = \"table\"\nmass = 50\nmeshes = [{ mesh = \"top\" }]\n" +
         (axis.empty() ? in_plane : in_space) +
         "[[joints]]\nname = \"axle\"\ntype = \"revolute\"\nbodies = [\"ground\", \"table\"]\n" +
         (axis.empty() ? "point = [0, 0]\n" : "point = [0, 0, 0]\naxis = [" + axis + "]\n") +
         "[[drivers]]\nname = \"motor\"\njoint = \"axle\"\nmotion = " + angle + "\n";
}

const std::string kPlane = "point = [0, 0, 0]\nnormal = [0, 0, 1]\n", kMesh = "mesh = \"top\"\n",
                  kBox =
                      "[[meshes]]\nname = \"top\"\nkind = \"box\"\nsize = [1, 1, 0.1]\noffset = [0, 0, "
                      "-0.05]\n",
                  kLine = "point = [0, 0]\nnormal = [0, 1]\n",
                  kLineMesh = "[[meshes]]\nname = \"top\"\nkind = \"line\"\npoints = [[0.5, 0], [-0.5, 0]]\n";

// A table of constant rotation about its normal. The ball rolls on it with 2/7 of its rate, on a circle.
constexpr Real kTableRate = 9;
const std::string kTableAngle = "{ kind = \"ramp\", rate = 9 }";
TurningDeck on_table(const std::string& name, const std::string& surfaces) {
  return {name,
          3,
          surfaces,
          fmt::format("0.06, 0.02, {:.17g}", kHeight),
          "-0.02, 0.09, 0",
          "37.5, 13.333333333333334, 4"};
}
// A table that tilts and rotates, from rest.
const std::string kTilt = "{ kind = \"step\", end_value = 0.5, start = 0, end = 0.3 }",
                  kTilted = "0.6, 0, 0.8";
TurningDeck on_tilting(const std::string& name, const std::string& surfaces) {
  return {name,
          3,
          surfaces,
          fmt::format("0.06, 0.02, {:.17g}", kHeight),
          "-0.02, 0.09, 0",
          "-7.5, -1.6666666666666667, 0"};
}
// belt: velocity of a conveyor line [m/s].
TurningDeck on_line(const std::string& name, const std::string& surfaces, Real belt = 0) {
  return {name,      2,
          surfaces,  fmt::format("0.1, {:.17g}", kHeight),
          "0.05, 0", fmt::format("{:.17g}", (belt - 0.05) / kRadius)};
}
// A sphere in the groove between two boxes, on an edge of each.
TurningDeck in_groove() {
  constexpr Real kHalf = 0.006;  // of the groove's width [m]
  const Real load = kMass * kGravity / 2 / std::cos(std::asin(kHalf / kRadius));
  const Real distance = kRadius - load / kStiffness, height = std::sqrt(distance * distance - kHalf * kHalf);
  std::string rails;
  for (const int side : {-1, 1})
    rails += fmt::format(
        "[[meshes]]\nname = \"rail{0}\"\nkind = \"box\"\nsize = [1, 0.1, 0.1]\noffset = [0, {1}, "
        "-0.05]\n[[walls]]\nname = \"rail{0}\"\nmesh = \"rail{0}\"\nmotions = [{{ type = \"rotation\", axis "
        "= "
        "[0.6, 0, 0.8], point = [0, 0, 0], angle = {{ kind = \"step\", end_value = 0.2, start = 0, end = 0.3 "
        "}} }}]\n",
        side, side * (0.05 + kHalf));
  return {"edges",     3,
          rails,       fmt::format("0.06, 0, {:.17g}", height),
          "0.2, 0, 0", fmt::format("0, {:.17g}, 0", 0.2 / height)};
}

std::vector<TurningDeck> all_decks() {
  return {on_table("plane", wall(kPlane, "0, 0, 1", kTableAngle)),
          on_table("mesh", kBox + wall(kMesh, "0, 0, 1", kTableAngle)),
          on_table("mesh of a body",
                   kBox + body("0, 0, 1", kTableAngle, "global_angular_velocity = [0, 0, 9]\n")),
          on_tilting("plane that tilts", wall(kPlane, kTilted, kTilt)),
          on_tilting("mesh that tilts", kBox + wall(kMesh, kTilted, kTilt)),
          on_tilting("mesh of a body that tilts", kBox + body(kTilted, kTilt, "")),
          on_line("line", wall(kLine, "", kTilt)),
          on_line("line of a mesh", kLineMesh + wall(kMesh, "", kTilt)),
          on_line("line of a body", kLineMesh + body("", kTilt, "")),
          on_line("line that runs", wall(kLine + "surface_velocity = [0.3, 0]\n", "", kTilt), 0.3),
          in_groove()};
}

struct Ended {
  Vec3 position;
  Real balance;  // balance error over the energies
};
Ended end_of(const TurningDeck& deck, const std::string& method, Real step) {
  SimulationRun run(model_of(deck.text(method, step, 0.2)));
  run.run();
  REQUIRE(run.particle_ledger().contacts > 0);
  return {run.particles()[0].position,
          std::abs(run.balance_error()) / (run.exchanged() + run.ledger().kinetic)};
}

}  // namespace

TEST_CASE(
    "a ball rolls over rotating planes, lines, meshes and edges at second order, and implicit steps balance "
    "the energy") {
  for (const TurningDeck& deck : all_decks())
    for (const std::string& method : kMethods) {
      const Ended coarse = end_of(deck, method, 2e-4), middle = end_of(deck, method, 1e-4),
                  fine = end_of(deck, method, 5e-5);
      const Real change = norm(coarse.position - middle.position),
                 next = norm(middle.position - fine.position), order = std::log2(change / next);
      CAPTURE(deck.name, method, change, next, coarse.balance, fine.balance);
      CHECK(near(order, 2, {.absolute = 0.05}));
      if (method == "hht") CHECK(coarse.balance < 1e-11);
    }
}

// Four revolutions of the table, 8/7 of a revolution of the ball: centre and radius of its circle follow
// from its motion at the start.
TEST_CASE("a ball on a turntable stays on its circle") {
  const Vec3 start{0.06, 0.02, 0};
  const Real rate = kTableRate * 2 / 7, end = 4 * 2 * M_PI / kTableRate;
  const Vec3 from_centre{0.09 / rate, 0.02 / rate, 0}, centre = start - from_centre;
  for (const TurningDeck& deck : {on_table("plane", wall(kPlane, "0, 0, 1", kTableAngle)),
                                  on_table("mesh", kBox + wall(kMesh, "0, 0, 1", kTableAngle))})
    for (const std::string& method : kMethods) {
      CAPTURE(deck.name, method);
      SimulationRun run(model_of(deck.text(method, 2e-4, end)));
      run.run();
      const Particle ball = run.particles()[0];
      const Vec3 arm{ball.position.x - centre.x, ball.position.y - centre.y, 0};
      CHECK(near(norm(arm), norm(from_centre), {.relative = 2e-5}));
      CHECK(near(arm, rotated(exponential({0, 0, rate * end}), from_centre), {.relative = 2e-4}));
    }
}

}  // namespace scree
