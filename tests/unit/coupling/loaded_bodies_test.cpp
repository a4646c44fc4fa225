#include "coupling/loaded_bodies.hpp"

#include <cmath>
#include <string>

#include "model/checks/body_load.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kPlate = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
end = 1.0
step = 1e-4
control = "fixed"
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
damping = 40.0
[[meshes]]
name = "sheet"
kind = "rectangle"
size = [0.4, 0.3]
[[bodies]]
name = "plate"
kind = "spatial"
mass = 0.1
inertia_tensor = [1e-3, 1e-3, 2e-3, 0.0, 0.0, 0.0]
position = [0.0, 0.0, -0.2]
meshes = [{ mesh = "sheet" }]
[[particles]]
name = "grains"
kind = "lattice"
origin = [-0.18, -0.13, 0.0]
spacing = [0.04, 0.04, 0.04]
size = [9, 7, 3]
radius = 0.01
mass = 0.5
)";

BodyMotion at(Vec3 place, Vec3 turn) {
  BodyMotion motion;
  motion.kind = BodyKind::spatial;
  motion.position = place, motion.orientation = exponential(turn);
  return motion;
}

}  // namespace

TEST_CASE("the wrench's slope is found by as many displacements as it has directions") {
  // The wrench of springs along z at two points, for a displacement and a small rotation.
  const auto wrench = [](Vec3 place, Vec3 turn) {
    BodyWrench sum;
    for (const Vec3 arm : {Vec3{0.1, 0.05, 0}, Vec3{-0.08, 0.02, 0}}) {
      const Vec3 force{0, 0, -1e5 * (place.z + cross(turn, arm).z)};
      sum += {force, cross(arm, force)};
    }
    return sum;
  };
  WrenchSlope slope;
  slope.begin(4e5, 0.2);
  const BodyMotion start = at({}, {});
  for (const auto& [place, turn] : {std::pair{Vec3{0, 0, 1e-6}, Vec3{}}, std::pair{Vec3{}, Vec3{2e-6, 0, 0}},
                                    std::pair{Vec3{}, Vec3{0, 1e-6, 0}}, std::pair{Vec3{1e-6, 0, 0}, Vec3{}},
                                    std::pair{Vec3{0, 1e-6, 0}, Vec3{}}, std::pair{Vec3{}, Vec3{0, 0, 1e-6}}})
    slope.observe(start, at(place, turn), wrench(place, turn));
  const Vec3 place{3e-6, 2e-6, -1e-6}, turn{1e-6, -2e-6, 3e-6};
  const BodyWrench predicted = slope.change(start, at(place, turn)), true_one = wrench(place, turn);
  CHECK(norm(predicted.force - true_one.force) < 1e-6 * norm(true_one.force));
  CHECK(norm(predicted.torque - true_one.torque) < 1e-6 * norm(true_one.torque));
}

// A negative slope would make Newton's matrix less definite.
TEST_CASE("contacts that open leave no stiffness where they were") {
  WrenchSlope slope;
  slope.begin(4e5, 0.2);
  slope.observe(at({}, {}), at({0, 0, 1e-6}, {}), {{0, 0, 5}, {}});
  CHECK(std::abs(slope.packed()[packed6(2, 2)]) < 1e-9 * 4e5);
  CHECK(slope.packed()[packed6(0, 0)] == 4e5);
}

TEST_CASE("a body's load counts its contacts, their stiffness and their damping") {
  const Model model = model_of(kPlate);
  const PressedBody plate = pressed_bodies(model).front();
  CHECK(plate.stiffness == 1e5);
  CHECK(plate.damping == 40);
  CHECK(near(plate.reach, 0.25, {.relative = 1e-12}));
  CHECK(near(plate.least_mass, 1 / (10 + 0.0625 / 1e-3), {.relative = 1e-12}));
  CHECK(near(plate.phase(16, 1e-4), 1e-4 * std::sqrt(16 * 1e5 / 0.1), {.relative = 1e-12}));
  CHECK(near(plate.load(16, 1e-4), 16 * (1e-8 * 1e5 + 1e-4 * 40) / plate.least_mass, {.relative = 1e-12}));
  LoadedBodies bodies(model);
  CHECK(bodies.can_be());
  CHECK_FALSE(bodies.are_loaded({0}, 1e-4));
  CHECK_FALSE(bodies.are_loaded({1}, 1e-6));
  CHECK(bodies.are_loaded({16}, 1e-4));
}

// The number of the smallest particles that fit on the plate, 0.12 m^2 over 2 sqrt(3) r^2; at most the 20
// that there are.
TEST_CASE("the step for the most contacts that a body can have") {
  const Model many = model_of(kPlate, {"particles.0.size=[9, 7, 9]"});
  CHECK(most_contacts(many, 0) == 347);
  const Model few = model_of(kPlate, {"particles.0.size=[5, 4, 1]"});
  CHECK(most_contacts(few, 0) == 20);
  const std::optional<LoadedStep> step = shortest_loaded_step(few);
  REQUIRE(step);
  CHECK(step->contacts == 20);
  CHECK(near(step->step, 1 / std::sqrt(20 * 1e5 / 0.1), {.relative = 1e-12}));
  Model alone = few;
  alone.bodies.clear();
  CHECK_FALSE(shortest_loaded_step(alone).has_value());
}

TEST_CASE(
    "a step that is too long for a body's contacts is warned of, by name and with the step that would do") {
  const Model model = model_of(kPlate, {"integrator.substeps=2"});
  LoadedBodies bodies(model);
  const std::vector<BodyMotion> motion{start_motion(model.bodies.front())};
  const std::vector<BodyWrench> none(1);
  bodies.open({20}, 1e-4, motion, none, none);
  CHECK(bodies.warning().empty());
  bodies.open({80}, 3e-4, motion, none, none);  // 2.68 rad
  const std::string warning = bodies.warning();
  CHECK(
      warning ==
      "body \"plate\" had 80 simultaneous contacts with particles, on which it oscillates by 2.68 rad per "
      "step "
      "of 0.0003 s, too fast for this step; set time.step to at most 0.00021 s with integrator.substeps = 1");
}

}  // namespace scree
