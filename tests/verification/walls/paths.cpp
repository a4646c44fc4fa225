// Positions and velocities of walls.
#include <cmath>
#include <vector>

#include "coupling/wall_motion.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/walls/wall_decks.hpp"

namespace scree {

TEST_CASE("velocity and spin of a wall are the rates of where it is, with motions one after the other") {
  WallDeck deck;
  deck.contact = "stiffness = 1e4\n", deck.grain = "positions = [[0, 0, 1]]\n";
  deck.wall =
      kFloor +
      motions(
          "{ type = \"rotation\", axis = [1, 2, 0], point = [0.3, 0, 0.2], angle = { kind = \"sine\", value "
          "= 5, amplitude = 0.8, frequency = 0.7 } }, { type = \"translation\", direction = [0, 1, 1], "
          "displacement = { kind = \"ramp\", value = 3, rate = 0.4 } }, { type = \"rotation\", axis = [0, 0, "
          "1], point = [1, 1, 0], angle = { kind = \"ramp\", rate = -2 } }");
  const WallMotions walls(deck.model());
  const auto at = [&](Real t) {
    std::vector<BodyMotion> motion(walls.size());
    walls.at(t, motion);
    return motion.at(0);
  };
  // At t = 0 at the deck's position, whatever the functions are there.
  CHECK(near(at(0).position, Vec3{}, {.absolute = 1e-15}));
  CHECK(near(at(0).orientation.w, 1.0, {.absolute = 1e-15}));
  const Real t = 0.37, d = 1e-5;
  const Vec3 place{0.5, -0.2, 0.9};
  const PointMotion before = point_motion(at(t - d), place), now = point_motion(at(t), place),
                    after = point_motion(at(t + d), place);
  CHECK(near(now.velocity, (1 / (2 * d)) * (after.position - before.position), {.absolute = 1e-8}));
  // The pose by hand: rotated, moved, rotated.
  const Vec3 axis = (1 / std::sqrt(5.0)) * Vec3{1, 2, 0}, first{0.3, 0, 0.2}, last{1, 1, 0};
  const Real angle = 0.8 * std::sin(2 * M_PI * 0.7 * t);
  Vec3 p = first + rotated(exponential(angle * axis), place - first);
  p += 0.4 * t * (1 / std::sqrt(2.0)) * Vec3{0, 1, 1};
  p = last + rotated(exponential({0, 0, -2 * t}), p - last);
  CHECK(near(now.position, p, {.absolute = 1e-14}));
}

}  // namespace scree
