// The lines of joints and force elements in snapshots.
#include "run/record/joint_lines.hpp"

#include <string>
#include <vector>

#include "coupling/body_coupling.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {
namespace {

struct Shown {
  explicit Shown(const std::string& deck) : model(model_of(deck)), run(model), lines(model) { sample(); }
  void sample() {
    const MultibodyState& state = run.bodies();
    at = lines.sample(run.multibody(), state, run.time(), run.multibody().motion(state));
  }

  Model model;
  SimulationRun run;
  JointLines lines;
  JointLines::Sample at;
};

std::string body(const std::string& name, const std::string& position, const std::string& more = "") {
  return "[[bodies]]\nname = \"" + name + "\"\nposition = " + position + "\nmass = 2.0\ninertia = 0.1\n" +
         more;
}

}  // namespace

TEST_CASE("the line of a pendulum goes from its pin to its centre, with the pin's reaction") {
  Shown shown(R"(gravity = [0.0, -10.0]
)" + kSmallDeck +
              body("bob", "[0.5, 0.0]") + R"([[joints]]
name = "pin"
type = "revolute"
bodies = ["ground", "bob"]
point = [0.0, 0.0]
)");
  CHECK(shown.lines.names() == std::vector<std::string>{"pin"});
  for (int step = 0; step < 3; ++step) {
    const std::vector<Reaction> reactions =
        shown.run.multibody().reactions(shown.run.bodies(), shown.run.time());
    CHECK(shown.at.force[0] == norm(reactions[0].force));
    CHECK(shown.at.reaction[0] == reactions[0].force);
    CHECK(near(shown.at.ends[0], Vec3{}, {.absolute = 1e-9}));
    CHECK(near(shown.at.length[0], 0.5, {.absolute = 1e-9}));
    shown.run.step(), shown.sample();
  }
  CHECK(shown.at.kind == std::vector{static_cast<int>(JointLineKind::joint)});
}

TEST_CASE("lines of spring-dampers and cylinders have their tension, torsional ones their torque") {
  Shown shown(kSmallDeck + body("one", "[0.3, 0.4]", "velocity = [0.6, 0.8]\nangular_velocity = 3.0\n") +
              body("two", "[0.3, 0.9]") + R"([[spring_dampers]]
name = "spring"
bodies = ["ground", "one"]
local_points = [[0.0, 0.0], [0.0, 0.0]]
stiffness = 100.0
damping = 7.0
free_length = 0.2
[[spring_dampers]]
name = "cylinder"
bodies = ["one", "two"]
local_points = [[0.0, 0.0], [0.0, 0.0]]
stiffness = 0.0
free_length = 0.1
actuator = { kind = "constant", value = -25.0 }
[[torsional_spring_dampers]]
name = "coil"
bodies = ["ground", "one"]
stiffness = 10.0
damping = 2.0
free_angle = 0.5
)");
  CHECK(shown.lines.names() == std::vector<std::string>{"spring", "cylinder", "coil"});
  CHECK(shown.at.kind == std::vector{1, 2, 4});
  CHECK(near(shown.at.force[0], 100 * (0.5 - 0.2) + 7 * 1.0, {.relative = 1e-14}));
  CHECK(near(shown.at.reaction[0], -37 * Vec3{0.6, 0.8, 0}, {.relative = 1e-14}));
  CHECK(shown.at.force[1] == -25);
  CHECK(near(shown.at.reaction[1], {0, 25, 0}, {.relative = 1e-14}));
  CHECK(near(shown.at.torque[2], 10 * 0.5 - 2 * 3.0, {.relative = 1e-14}));
  CHECK(near(shown.at.length[0], 0.5, {.relative = 1e-14}));
}

TEST_CASE("the line of a cylinder has its tension, which is a reaction in the history") {
  for (const Real force : {25.0, -25.0}) {
    Shown shown(kSmallDeck + body("one", "[0.3, 0.4]") + body("two", "[0.3, 0.9]") +
                R"([[spring_dampers]]
name = "spring"
bodies = ["ground", "one"]
local_points = [[0.0, 0.0], [0.0, 0.0]]
stiffness = 100.0
free_length = 0.2
[[cylinders]]
name = "lift"
bodies = ["one", "two"]
type = "force"
force = )" + std::to_string(force));
    CHECK(shown.lines.names() == std::vector<std::string>{"lift", "spring"});
    CHECK(shown.at.kind == std::vector{2, 1});
    CHECK(near(shown.at.force[0], -force, {.relative = 1e-14}));
    CHECK(near(shown.at.reaction[0], {0, force, 0}, {.relative = 1e-14}));
    CHECK(near(shown.at.length[0], 0.5, {.relative = 1e-14}));
    CHECK(near(shown.at.force[1], 100 * (0.5 - 0.2), {.relative = 1e-14}));
    const std::vector<Reaction> reactions =
        shown.run.multibody().reactions(shown.run.bodies(), shown.run.time());
    CHECK(reactions.at(0).joint == "lift");
  }
}

TEST_CASE("the line of a bushing has its load along the global axes") {
  Shown shown(R"([space]
dimension = 3
min = [-2.0, -2.0, -2.0]
max = [2.0, 2.0, 2.0]
[time]
end = 1.0
step = 1e-3
[[contact.pairs]]
stiffness = 1e4
[[bodies]]
name = "block"
kind = "spatial"
position = [0.1, 0.0, 0.5]
mass = 1.0
inertia_tensor = [0.1, 0.1, 0.1, 0.0, 0.0, 0.0]
[[bushings]]
name = "rubber"
bodies = ["ground", "block"]
local_points = [[0.0, 0.0, 0.0], [0.0, 0.0, -0.5]]
axis = [0.3, 0.0, 1.0]
second_axis = [1.0, 0.0, -0.3]
stiffness = [500.0, 500.0, 500.0, 0.0, 0.0, 0.0]
)");
  REQUIRE(shown.at.kind == std::vector{3});
  CHECK(near(shown.at.reaction[0], {-50, 0, 0}, {.relative = 1e-13}));
  CHECK(near(shown.at.force[0], 50.0, {.relative = 1e-13}));
  CHECK(near(shown.at.length[0], 0.5, {.relative = 1e-14}));
}

}  // namespace scree
