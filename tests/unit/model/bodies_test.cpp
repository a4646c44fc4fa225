// Bodies, rows, joints and force elements.
#include <numbers>

#include "model/derived/connections.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = kUlp;  // of positions up to 1 m [m]

const std::string kDeck = kSmallDeck + R"(
[[bodies]]
name = "a"
mass = 1.0
inertia = 0.1
position = [0.5, 0.0]
angle = 1.5707963267948966
[[bodies]]
name = "row"
count = 4
spacing = [0.1, 0.2]
mass = 2.0
inertia = 0.1
position = [-0.5, -0.5]
)";

}  // namespace

TEST_CASE("a row of bodies") {
  const Model model = model_of(kDeck);
  REQUIRE(model.bodies.size() == 5);
  CHECK(model.bodies[0].name == "a");
  CHECK(model.bodies[4].name == "row.3");
  CHECK(near(model.bodies[4].position.x, -0.2, {.absolute = kRoundOff}));
  CHECK(near(model.bodies[4].position.y, 0.1, {.absolute = kRoundOff}));
}

TEST_CASE("a joint's global point in both body frames") {
  const Model model = model_of(
      kDeck +
      "[[joints]]\nname = \"j\"\ntype = \"revolute\"\nbodies = [\"ground\", \"a\"]\npoint = [0.2, 0.1]\n");
  const Joint& joint = model.joints[0];
  CHECK(joint.body[0] == kGround);
  CHECK(norm(joint.point[0] - Vec3{0.2, 0.1, 0}) < 1e-15);
  CHECK(norm(joint.point[1] - Vec3{0.1, 0.3, 0}) < 1e-15);
  CHECK(norm(to_global_point(model, 0, joint.point[1]) - Vec3{0.2, 0.1, 0}) < 1e-15);
}

TEST_CASE("the other joints") {
  const Model slide = model_of(
      kDeck +
      "[[joints]]\nname = \"j\"\ntype = \"translational\"\nbodies = [\"a\", \"row.0\"]\naxis = [0.0, 2.0]\n");
  CHECK(norm(slide.joints[0].axis - Vec3{1, 0, 0}) < 1e-15);
  CHECK(near(slide.joints[0].angle_offset, -std::numbers::pi / 2, {.absolute = kRoundOff}));
  const Model rod =
      model_of(kDeck + "[[joints]]\nname = \"j\"\ntype = \"distance\"\nbodies = [\"a\", \"row.0\"]\n");
  CHECK(rod.joints[0].distance == std::hypot(1.0, 0.5));
  const Model welded =
      model_of(kDeck + "[[joints]]\nname = \"j\"\ntype = \"fixed\"\nbodies = [\"a\", \"row.0\"]\n");
  CHECK(welded.joints[0].kind == JointKind::fixed);
  CHECK(norm(to_global_point(welded, 1, welded.joints[0].point[1]) - Vec3{0, -0.25, 0}) < 1e-15);
}

TEST_CASE("chains, and one joint for each body of a row") {
  const Model model = model_of(kDeck + R"(
[[joints]]
name = "hinge"
type = "revolute"
chain = "row"
[[joints]]
name = "pin"
type = "revolute"
each = "a"
[[spring_dampers]]
name = "cord"
chain = "row"
stiffness = 5.0
[[torsional_spring_dampers]]
name = "twist"
each = "row"
stiffness = 1.0
[[drivers]]
name = "d"
joint = "hinge.2"
motion = { kind = "ramp", rate = 2.0 }
)");
  REQUIRE(model.joints.size() == 4);
  CHECK(model.joints[2].name == "hinge.2");
  CHECK(model.joints[2].body[0] == 3);
  CHECK(model.joints[2].body[1] == 4);
  CHECK(model.joints[3].name == "pin.0");
  CHECK(norm(model.joints[3].point[1]) < 1e-15);
  REQUIRE(model.spring_dampers.size() == 3);
  CHECK(near(model.spring_dampers[0].free_length, std::hypot(0.1, 0.2), {.absolute = kRoundOff}));
  CHECK(model.torsional_spring_dampers.size() == 4);
  CHECK(model.drivers[0].joint == 2);
  CHECK(model.drivers[0].motion.rate == 2);
}

TEST_CASE("applied forces and their functions of time") {
  const Model model = model_of(kDeck + R"(
[[applied_forces]]
name = "f"
body = "a"
point = [0.5, 0.2]
fx = 3.0
fy = { kind = "sine", amplitude = 2.0, frequency = 5.0, phase = 0.1 }
torque_z = { kind = "table", times = [0.0, 1.0], values = [0.0, 4.0] }
follows_body = true
)");
  const AppliedForce& force = model.applied_forces[0];
  CHECK(norm(force.point - Vec3{0.2, 0, 0}) < 1e-15);
  CHECK(force.fx.kind == TimeFunction::Kind::constant);
  CHECK(force.fx.value == 3);
  CHECK(force.fy.frequency == 5);
  CHECK(force.torque.values == std::vector<Real>{0, 4});
  CHECK(force.follows_body);
}

TEST_CASE("how tables are read, steps, and velocities that agree") {
  const Model model = model_of("velocities = \"consistent\"\n" + kSmallDeck + R"(
[[bodies]]
name = "a"
position = [0.0, 0.0]
mass = 1.0
inertia = 0.1
[[bodies]]
name = "row"
count = 2
position = [0.0, 0.5]
spacing = [0.1, 0.0]
mass = 1.0
inertia = 0.1
[[joints]]
name = "pin"
type = "revolute"
bodies = ["ground", "a"]
[[drivers]]
name = "natural"
joint = "pin"
motion = { kind = "table", times = [0.0, 1.0], values = [0.0, 4.0] }
[[drivers]]
name = "clamped"
joint = "pin"
motion = { kind = "table", times = [0.0, 1.0], values = [0.0, 4.0], interpolation = "clamped", end_rates = [1, 2] }
[[drivers]]
name = "step"
joint = "pin"
motion = { kind = "step", value = 1.0, end_value = 2.0, start = 0.25, end = 0.5 }
[[applied_forces]]
name = "push"
body = "a"
fx = { kind = "table", times = [0.0, 1.0], values = [0.0, 4.0] }
fy = { kind = "table", times = [0.0, 1.0], values = [0.0, 4.0], interpolation = "monotone" }
)");
  CHECK(model.consistent_velocities);
  CHECK(!model.bodies[0].in_row);
  CHECK(model.bodies[2].in_row);
  CHECK(model.drivers[0].motion.interpolation == Interpolation::natural);
  CHECK(model.drivers[1].motion.interpolation == Interpolation::clamped);
  CHECK(model.drivers[1].motion.end_rates == std::array<Real, 2>{1, 2});
  const TimeFunction& step = model.drivers[2].motion;
  CHECK(step.kind == TimeFunction::Kind::step);
  CHECK(step.value == 1);
  CHECK(step.end_value == 2);
  CHECK(step.start == 0.25);
  CHECK(step.end == 0.5);
  CHECK(model.applied_forces[0].fx.interpolation == Interpolation::linear);
  CHECK(model.applied_forces[0].fy.interpolation == Interpolation::monotone);
}

TEST_CASE("materials, pairs and walls") {
  const Model model = model_of(kSmallDeck + R"(
[[materials]]
name = "glass"
[[materials]]
name = "steel"
[[contact.pairs]]
materials = ["steel", "glass"]
stiffness = 7.0
damping = 0.5
exponent = 1.5
limit_damping = false
[[walls]]
name = "plane"
point = [0.0, 0.0]
normal = [3.0, 4.0]
material = "steel"
)",
                               {"space.y_max=wall", "space.wall_material=glass"});
  CHECK(model.contact.law(0, 1).normal_stiffness == 7);
  CHECK(model.contact.law(1, 0).exponent == 1.5);
  CHECK(model.contact.law(1, 0).tension);
  CHECK(model.contact.law(0, 0).normal_stiffness == 0);
  REQUIRE(model.walls.size() == 2);
  CHECK(near(model.walls[0].normal.y, 0.8, {.absolute = kRoundOff}));
  CHECK(model.walls[0].material == 1);
  CHECK(model.walls[1].name == "y_max");
  CHECK(model.walls[1].normal == Vec3{0, -1, 0});
  CHECK(model.walls[1].point.y == 1);
}

}  // namespace scree
