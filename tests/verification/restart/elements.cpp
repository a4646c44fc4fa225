// Motors, springs, limits, friction, bushings and loops of revolute joints, stopped at many instants and
// restarted: the bits of the uninterrupted run.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "output/checkpoint.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"

using namespace scree;

namespace {

// An arm on an oblique revolute joint, and a slider on the arm.
const std::string kCrane = R"(
gravity = [0.0, 0.0, -9.81]
velocities = "consistent"
[space]
dimension = 3
min = [-2.0, -2.0, -2.0]
max = [2.0, 2.0, 2.0]
[time]
end = 0.8
step = 2e-3
control = "fixed"
[integrator]
hht_alpha = -0.05
[output]
history_interval = 0.05
[[bodies]]
name = "arm"
kind = "spatial"
position = [0.3, 0.1, 0.0]
mass = 1.5
inertia_tensor = [0.05, 0.06, 0.04, 0.002, 0.0, 0.001]
rotation_axis = [0.2, 0.1, -0.3]
rotation_angle = 0.4
[[bodies]]
name = "slider"
kind = "spatial"
position = [0.5, 0.1, 0.05]
mass = 0.6
inertia_tensor = [0.002, 0.003, 0.0025, 0.0, 0.0, 0.0]
center_of_mass = [0.02, 0.0, 0.01]
[[joints]]
name = "hinge"
type = "revolute"
bodies = ["ground", "arm"]
point = [0.0, 0.1, 0.0]
axis = [0.36, 0.48, 0.8]
[[joints]]
name = "slide"
type = "cylindrical"
bodies = ["arm", "slider"]
point = [0.5, 0.1, 0.0]
axis = [0.8, 0.0, 0.6]
)";

// At its limit first, then rotates the arm through several revolutions.
const std::string kSpeedMotor = R"(
[[motors]]
name = "drive"
joint = "hinge"
type = "speed"
rate = { kind = "sine", value = 30.0, amplitude = 20.0, frequency = 2.0 }
gain = 1.0
integral_gain = 20.0
limit = 20.0
)";
const std::string kOtherMotors = R"(
[[motors]]
name = "line"
joint = "slide"
coordinate = "displacement"
type = "torque-speed"
stall_effort = 12.0
free_rate = 3.0
[[motors]]
name = "effort"
joint = "hinge"
type = "effort"
effort = { kind = "sine", amplitude = 6.0, frequency = 1.5 }
[[motors]]
name = "servo"
joint = "hinge"
type = "position"
position = { kind = "sine", amplitude = 1.0, frequency = 1.0 }
position_gain = 4.0
rate_gain = 0.2
limit = 1.5
[[cylinders]]
name = "cylinder"
bodies = ["ground", "slider"]
points = [[0.0, -0.7, 0.1], [0.5, 0.1, 0.0]]
type = "speed"
speed = { kind = "sine", amplitude = 1.0, frequency = 2.0 }
gain = 3.0
integral_gain = 20.0
limit = 2.0
min_length = 0.5
max_length = 1.2
stop_stiffness = 2000.0
stop_damping = 3.0
)";
const std::string kSprings = R"(
[[joint_springs]]
name = "back"
joint = "slide"
coordinate = "displacement"
stiffness = 60.0
damping = 0.5
[[joint_springs]]
name = "coil"
joint = "hinge"
stiffness = 0.3
)";
const std::string kStop = R"(
[[joint_limits]]
name = "stop"
joint = "slide"
coordinate = "displacement"
lower = -0.05
upper = 0.05
stiffness = 3000.0
damping = 4.0
exponent = 1.5
)";
const std::string kFriction = R"(
[[joint_frictions]]
name = "dry"
joint = "hinge"
effort = 0.3
stiffness = 20.0
static_ratio = 1.4
stribeck_rate = 0.5
[[joint_frictions]]
name = "friction"
joint = "slide"
coordinate = "displacement"
friction_coefficient = 0.6
stiffness = 800.0
damping = 0.5
[[joint_frictions]]
name = "turn"
joint = "slide"
coordinate = "angle"
friction_coefficient = 0.3
radius = 0.02
stiffness = 5.0
)";
const std::string kBushing = R"(
[[bodies]]
name = "block"
kind = "spatial"
position = [0.6, 0.2, 0.0]
mass = 0.8
inertia_tensor = [0.003, 0.002, 0.004, 0.0, 0.0, 0.0]
[[bushings]]
name = "rubber"
bodies = ["slider", "block"]
point = [0.55, 0.15, 0.02]
axis = [0.3, 0.1, 1.0]
second_axis = [1.0, 0.0, -0.3]
stiffness = [500.0, 600.0, 700.0, 4.0, 5.0, 6.0]
damping = [3.0, 3.0, 3.0, 0.02, 0.02, 0.02]
preload = [1.0, -0.5, 2.0, 0.05, 0.0, -0.02]
)";
std::string bar(const std::string& name, const std::string& position, const std::string& moments,
                const std::string& more = "") {
  return "[[bodies]]\nname = \"" + name + "\"\nkind = \"spatial\"\nposition = " + position +
         "\nmass = 1.0\ninertia_tensor = [" + moments + ", 0.0, 0.0, 0.0]\n" + more;
}
std::string pin(const std::string& name, const std::string& bodies, const std::string& point) {
  return "[[joints]]\nname = \"" + name + "\"\ntype = \"revolute\"\nbodies = " + bodies +
         "\npoint = " + point + "\naxis = [0.0, 1.0, 0.0]\n";
}
// A loop with three redundant rows.
const std::string kLoop =
    bar("left", "[-1.0, 0.0, 0.5]", "0.08, 0.08, 0.001") +
    bar("right", "[-0.3, 0.0, 0.5]", "0.08, 0.08, 0.001") +
    bar("rail", "[-0.65, 0.0, 1.0]", "0.001, 0.08, 0.08", "velocity = [1.0, 0.0, 0.0]\n") +
    pin("left_foot", R"(["ground", "left"])", "[-1.0, 0.0, 0.0]") +
    pin("right_foot", R"(["ground", "right"])", "[-0.3, 0.0, 0.0]") +
    pin("left_top", R"(["left", "rail"])", "[-1.0, 0.0, 1.0]") +
    pin("right_top", R"(["right", "rail"])", "[-0.3, 0.0, 1.0]") + R"(
[[joint_frictions]]
name = "foot"
joint = "left_foot"
friction_coefficient = 0.4
radius = 0.02
stiffness = 40.0
)";

struct Case {
  std::string name;
  Model model;
};

const std::string kShare = "integrator.redundant=minimum-norm";

Model everything(std::vector<std::string> overrides = {}) {
  overrides.push_back(kShare);
  return model_of(kCrane + kSpeedMotor + kOtherMotors + kSprings + kStop + kFriction + kBushing + kLoop,
                  overrides);
}

// Each kind alone, all of them together, and two decks of planar bodies.
std::vector<Case> cases() {
  return {{"speed motor", model_of(kCrane + kSpeedMotor)},
          {"other motors", model_of(kCrane + kOtherMotors)},
          {"springs", model_of(kCrane + kSprings)},
          {"stop", model_of(kCrane + kStop)},
          {"friction", model_of(kCrane + kFriction)},
          {"bushing", model_of(kCrane + kBushing)},
          {"loop", model_of(kCrane + kLoop, {kShare})},
          {"all", everything()},
          {"all, adaptive", everything({"time.control=adaptive", "time.end=0.3"})},
          {"press", input_model("examples/press.toml", {"time.end=0.8"})},
          {"stick and slip", input_model("examples/stick_slip.toml", {"time.end=1.5"})}};
}

constexpr int kInstants = 12;

// The final state of the whole run; calls visit(state) at some instants.
template <class Visit>
State whole_run(const Model& model, const Visit& visit) {
  SimulationRun run(model);
  for (int i = 1; i <= kInstants; ++i) {
    run.run_until(i * model.time.end / (kInstants + 1));
    visit(run.complete_state());
  }
  run.run();
  return run.complete_state();
}

State continued(const Model& model, const State& state) {
  SimulationRun run(model, state);
  run.run();
  return run.complete_state();
}

}  // namespace

TEST_CASE("elements of joints continue from a checkpoint at any instant bit for bit") {
  for (const Case& one : cases()) {
    CAPTURE(one.name);
    const ScratchDirectory folder;
    std::vector<std::string> files;
    const State end = whole_run(one.model, [&](const State& state) {
      files.push_back(folder / (std::to_string(files.size()) + ".h5"));
      write_checkpoint(files.back(), pack(state));
    });
    CHECK(end.counts.steps >= 400);
    for (const std::string& file : files) {
      const State again = continued(one.model, unpack(read_checkpoint(file)));
      CHECK(differing_arrays(pack(again), pack(end)) == "");
    }
  }
}

// Shows that the test above detects missing parts of a checkpoint.
TEST_CASE("every number in the memory of joint elements matters") {
  const Model model = everything();
  std::vector<State> states;
  const State end = whole_run(model, [&](const State& state) { states.push_back(state); });
  const State& middle = states[kInstants / 2];
  REQUIRE(middle.bodies.memory.size() == 6);
  REQUIRE(middle.bodies.counted_angles == 6);
  for (std::size_t k = 0; k < 6; ++k) {
    CAPTURE(k);
    State without = middle;
    REQUIRE(std::exchange(without.bodies.memory[k], 0) != 0);
    const State other = continued(model, without);
    CHECK(differing_arrays(pack(other), pack(end)) != "");
  }
  State rotated = middle;  // a revolution of the arm, on which a spring acts
  rotated.bodies.position[rotated.bodies.position.size() - 6] += 2 * M_PI;
  const State other = continued(model, rotated);
  CHECK(differing_arrays(pack(other), pack(end)) != "");
}
