// Refused keys of moving walls, and warnings of walls that bodies do not touch.
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "verification/walls/wall_decks.hpp"

namespace scree {

namespace {

std::string error_of(const std::string& motion) {
  WallDeck deck;
  deck.wall = kFloor + motions(motion), deck.contact = "stiffness = 1e4\n";
  deck.grain = "positions = [[0, 0, 1]]\n";
  return model_error(deck.text());
}

}  // namespace

TEST_CASE("motions of walls that mean nothing are refused, and the message names the key") {
  struct Case {
    std::string motion, says;
  };
  const std::vector<Case> cases = {
      {"{ type = \"screw\", direction = [1, 0, 0], displacement = 0 }", "translation"},
      {"{ type = \"translation\", direction = [0, 0, 0], displacement = 0 }", "direction = "},
      {"{ type = \"translation\", direction = [1, 0, 0] }", "displacement"},
      {"{ type = \"translation\", direction = [1, 0, 0], angle = 1, displacement = 0 }", "angle"},
      {"{ type = \"rotation\", axis = [0, 0, 0], point = [0, 0, 0], angle = 0 }", "axis = "},
      {"{ type = \"rotation\", point = [0, 0, 0], angle = 0 }", "axis: missing"},
      {"{ type = \"translation\", direction = [1, 0, 0], displacement = { kind = \"table\", times = [0, "
       "0.5], "
       "values = [0, 1] } }",
       "must cover the whole run"},
      {"{ type = \"translation\", direction = [1, 0, 0], displacement = { kind = \"table\", times = [0, 2], "
       "values = [0, 1], interpolation = \"linear\" } }",
       "must not jump"}};
  for (const Case& c : cases) {
    CAPTURE(c.motion);
    const std::string error = error_of(c.motion);
    CHECK(error.find("deck.toml:") != std::string::npos);
    CHECK(error.find(c.says) != std::string::npos);
  }
}

TEST_CASE("conveyors with cohesion beyond touch are supported in explicit steps alone") {
  WallDeck deck;
  deck.grain = "positions = [[0, 0, 1]]\n",
  deck.contact = "stiffness = 1e4\nattraction = 0.1\nattraction_range = 0.1\n";
  deck.wall = kFloor + "surface_velocity = [1, 0, 0]\n";
  CHECK(model_error(deck.text()).find("needs integrator.particles = \"velocity-verlet\"") !=
        std::string::npos);
  deck.particles = "velocity-verlet";
  CHECK(deck.model().is_cohesive());
}

TEST_CASE("in 2D walls rotate about z, and an axis is refused") {
  const auto deck = [](const std::string& axis) {
    return "[space]\ndimension = 2\nmin = [-1, -1]\nmax = [1, 1]\n[time]\nend = 1\nstep = 1e-3\n"
           "[[contact.pairs]]\nstiffness = 1e4\n[[walls]]\nname = \"plate\"\npoint = [0, 0]\nnormal = [0, "
           "1]\n"
           "motions = [{ type = \"rotation\", " +
           axis +
           "point = [0, 0], angle = { kind = \"ramp\", rate = 1 } }]\n[[particles]]\nname = \"disc\"\nkind = "
           "\"list\"\npositions = [[0, 0.5]]\nradius = 0.1\nmass = 1\n";
  };
  CHECK(model_of(deck("")).walls.at(0).motions.at(0).axis == Vec3{0, 0, 1});
  CHECK(model_error(deck("axis = [0, 1], ")).find("about z") != std::string::npos);
}

}  // namespace scree
