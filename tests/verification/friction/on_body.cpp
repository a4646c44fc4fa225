// Friction of discs on the disc of a body that is fixed, translates or rotates: against closed forms.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "base/rotation.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

constexpr Real kGravity = 9.81;

// A disc on one so large that it is a plane, both as fast as the belt, and the disc faster by v0.
constexpr Real kBelt = 1e5, kRadius = 0.1, kMass = 1, kFriction = 0.25, kStiffness = 1e5, kSpeed = 2;
Model belt_model(Real belt, Real end, const std::vector<std::string>& settings) {
  return model_of(fmt::format(R"(
gravity = [0.0, -{g}]
velocities = "consistent"
[space]
dimension = 2
min = [-2e5, -3e5]
max = [2e5, 1.0]
[time]
end = {end}
step = 2e-5
[integrator]
particles = "velocity-verlet"
[contact]
skin = 0.01
[[contact.pairs]]
stiffness = {k}
friction = {mu}
tangential_stiffness = {k}
tangential_damping_ratio = 0.3
[[bodies]]
name = "belt"
position = [0.0, -{big}]
mass = 10.0
inertia = 1e12
shapes = [{{ radius = {big} }}]
[[joints]]
name = "guide"
type = "translational"
bodies = ["ground", "belt"]
axis = [1.0, 0.0]
[[drivers]]
name = "motor"
joint = "guide"
motion = {{ kind = "ramp", rate = {belt} }}
[[particles]]
name = "disc"
kind = "list"
positions = [[0.0, {y}]]
velocity = [{v0}, 0.0]
radius = {R}
mass = {m}
[output]
history_contacts = ["belt"]
)",
                              fmt::arg("g", kGravity), fmt::arg("mu", kFriction), fmt::arg("end", end),
                              fmt::arg("y", kRadius - kMass * kGravity / kStiffness), fmt::arg("m", kMass),
                              fmt::arg("v0", belt + kSpeed), fmt::arg("R", kRadius), fmt::arg("big", kBelt),
                              fmt::arg("k", kStiffness), fmt::arg("belt", belt)),
                  settings);
}

// A revolute joint of a body with the ground, driven at this rate.
std::string driven_axle(const std::string& body, Real rate) {
  return fmt::format(R"([[joints]]
name = "axle"
type = "revolute"
bodies = ["ground", "{}"]
[[drivers]]
name = "motor"
joint = "axle"
motion = {{ kind = "ramp", rate = {} }}
)",
                     body, rate);
}

// A disc between two discs of one body, which rotates at kHeldRate: they hold it at kOut from the axle
// against the centrifugal force.
constexpr Real kHeldRate = 5, kOut = 0.3, kHolder = 0.05, kPressed = 2e-4;
Model rotating_model(int dimension, const std::vector<std::string>& settings) {
  const Real apart = kHolder + kRadius - kPressed;
  const std::string zero = dimension == 2 ? "" : ", 0.0", one = dimension == 2 ? "" : ", -1.0",
                    far = dimension == 2 ? "" : ", 1.0";
  return model_of(
      fmt::format(
          R"(
velocities = "consistent"
[space]
dimension = {dimension}
min = [-1.0, -1.0{one}]
max = [1.0, 1.0{far}]
[time]
end = {end}
step = 2e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = {k}
damping = 100.0
friction = 0.9
tangential_stiffness = {k}
tangential_damping_ratio = 0.3
[[bodies]]
name = "holder"
position = [0.0, 0.0{zero}]
mass = 10.0
inertia = 1.0
shapes = [{{ radius = {r}, offset = [{out}, {apart}{zero}] }}, {{ radius = {r}, offset = [{out}, -{apart}{zero}] }}]
{axle}[[particles]]
name = "held"
kind = "list"
positions = [[{out}, 0.0{zero}]]
velocity = [0.0, {v}{zero}]
angular_velocity = {spin}
radius = {R}
mass = {m}
)",
          fmt::arg("dimension", dimension), fmt::arg("zero", zero), fmt::arg("one", one),
          fmt::arg("far", far), fmt::arg("k", kStiffness),
          fmt::arg("end", 2.5 * 2 * std::numbers::pi_v<Real>), fmt::arg("r", kHolder), fmt::arg("out", kOut),
          fmt::arg("apart", apart), fmt::arg("axle", driven_axle("holder", kHeldRate)),
          fmt::arg("v", kHeldRate * kOut), fmt::arg("R", kRadius), fmt::arg("m", kMass),
          fmt::arg("spin", fmt::format("[{}{}]", dimension == 2 ? "" : "0.0, 0.0, ", kHeldRate))),
      settings);
}

constexpr Real kWheel = 0.09;

// A disc on a wheel that rotates under it, held by a frictionless wall.
Model wheel_model(Real rate, const std::vector<std::string>& settings) {
  return model_of(fmt::format(R"(
gravity = [0.0, -{g}]
velocities = "consistent"
[space]
dimension = 2
min = [-1.0, -1.0]
max = [{R}, 1.0]
x_max = "wall"
wall_material = "smooth"
[time]
end = 0.05
step = 1e-5
[integrator]
particles = "velocity-verlet"
[[materials]]
name = "rough"
[[materials]]
name = "smooth"
[[contact.pairs]]
materials = ["rough", "rough"]
stiffness = {k}
damping = 200.0
friction = {mu}
tangential_stiffness = {k}
[[contact.pairs]]
materials = ["rough", "smooth"]
stiffness = {k}
damping = 200.0
[[bodies]]
name = "wheel"
position = [0.0, -{r}]
mass = 10.0
inertia = 1.0
shapes = [{{ radius = {r}, material = "rough" }}]
{axle}[[particles]]
name = "disc"
kind = "list"
positions = [[0.0, {y}]]
radius = {R}
mass = {m}
material = "rough"
[output]
history_contacts = ["wheel"]
)",
                              fmt::arg("g", kGravity), fmt::arg("R", kRadius), fmt::arg("k", kStiffness),
                              fmt::arg("mu", kFriction), fmt::arg("r", kWheel),
                              fmt::arg("axle", driven_axle("wheel", rate)), fmt::arg("m", kMass),
                              fmt::arg("y", kRadius - kMass * kGravity / kStiffness)),
                  settings);
}

// Settings of the integrator; implicit steps are some times longer.
std::vector<std::string> steps_of(std::string_view integrator) {
  if (integrator == "explicit") return {};
  std::vector<std::string> settings = implicit_steps(-0.05);
  settings.push_back("time.step=1e-4");
  return settings;
}

// The held disc in the body's frame.
struct Held {
  Vec3 position, spring;  // [m], on the first surface [N]
  Real rotation;          // rotation of the disc against the body [rad], small

  explicit Held(SimulationRun& run) {
    const State& state = run.complete_state();
    const Particle& p = state.particles.at(0);
    const Rotation back(-state.bodies.position.at(2));
    position = back.turn(p.position);
    REQUIRE(state.contacts.keys.size() == 2);
    spring = back.turn({state.contacts.values.at(0), state.contacts.values.at(1), 0});
    const Real half = state.bodies.position.at(2) / 2;
    rotation = 2 * (p.orientation.z * std::cos(half) - p.orientation.w * std::sin(half));
  }
};

}  // namespace

// The closed form is that of a wall, relative to the belt: the disc rolls at two thirds of v0 after v0 / (3
// mu g).
TEST_CASE("a disc that slides on a body's very large disc rolls in the end, whether that moves or not") {
  const char* integrator = GENERATE("explicit", "implicit");
  const Real belt = GENERATE(0.0, -2.0, 3.0);
  CAPTURE(integrator, belt);
  const Real t_roll = kSpeed / (3 * kFriction * kGravity);
  SimulationRun run(belt_model(belt, 1.5 * t_roll, steps_of(integrator)));
  run.run_until(t_roll / 2);
  Particle p = run.particles().at(0);
  CHECK(near(p.velocity.x - belt, kSpeed - kFriction * kGravity * run.time(), {.absolute = 2e-4}));
  const std::vector<Real> on_belt = run.contact_values();
  const Real weight = kMass * kGravity, x = p.position.x - run.bodies().position.at(0);
  CHECK(near(Vec3{on_belt[0], on_belt[1], 0}, {kFriction * weight, -weight, 0}, {.relative = 1e-4}));
  CHECK(near(on_belt[5], -kFriction * weight * kBelt - x * weight, {.relative = 1e-4}));
  run.run();
  p = run.particles().at(0);
  const Real v = p.velocity.x - belt;
  CHECK(keeps(v / (2 * kSpeed / 3) - 1, {.promise = 1e-4, .measured = 7e-6}));
  CHECK(keeps(-kRadius * p.angular_velocity.z / v - 1, {.promise = 1e-7, .measured = 7e-10}));
  CHECK(keeps(run.particle_ledger().contact_loss / (kMass * kSpeed * kSpeed / 6) - 1,
              {.promise = 1e-3, .measured = 7.2e-5}));
  const ParticleLedger ledger = run.particle_ledger();  // nothing damps normal forces
  CHECK(near(ledger.rotation.losses.of[kFrictionLoss], ledger.contact_loss, {.relative = 1e-12}));
  CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-3, .measured = 7.4e-5}));
}

TEST_CASE(
    "the friction of a disc brakes a wheel that rotates under it, and the wheel's motor does that work") {
  constexpr Real kWheelRate = -50;
  const char* integrator = GENERATE("explicit", "implicit");
  CAPTURE(integrator);
  SimulationRun run(wheel_model(kWheelRate, steps_of(integrator)));
  run.run_until(0.025);
  const Real work = run.ledger().driver_work, from = run.time();
  const std::vector<Real> on_wheel = run.contact_values();
  run.run();
  REQUIRE(kRadius * run.particles().at(0).angular_velocity.z <
          -kWheel * kWheelRate / 2);  // it is still sliding
  const Real torque = kFriction * kMass * kGravity * kWheel;
  CHECK(near(on_wheel[5], torque, {.relative = 1e-3}));
  CHECK(
      near(run.ledger().driver_work - work, -torque * kWheelRate * (run.time() - from), {.relative = 1e-3}));
  CHECK(near(run.balance_error(), 0, {.absolute = 1e-8 * run.exchanged()}));
  const ParticleLedger ledger = run.particle_ledger();
  CHECK(ledger.rotation.losses.of[kFrictionLoss] <= ledger.contact_loss);
  CHECK(near(ledger.rotation.losses.of[kFrictionLoss], ledger.contact_loss, {.relative = 1e-2}));
}

TEST_CASE("a disc held by friction on a rotating body stays in place, with its springs") {
  const int dimension = GENERATE(2, 3);
  const char* integrator = GENERATE("explicit", "implicit");
  CAPTURE(dimension, integrator);
  SimulationRun run(rotating_model(dimension, steps_of(integrator)));
  const Real revolution = 2 * std::numbers::pi_v<Real> / kHeldRate;
  run.run_until(2 * revolution);  // it has come to rest on the body
  const Held before(run);
  // The centripetal force, half from each.
  CHECK(near(norm(before.spring), kMass * kHeldRate * kHeldRate * kOut / 2, {.relative = 1e-2}));
  run.run_until(12.3 * revolution);
  const Held after(run);
  CHECK(near(after.position, before.position, {.absolute = 1e-9}));
  CHECK(near(after.spring, before.spring, {.relative = 1e-6}));
  // Error of an orientation that rotates by 2 atan(h w / 2) in a step: (h w)^3 / 12 too little.
  const Real rotation = 10.3 * revolution * kHeldRate, in_step = run.step() * kHeldRate;
  CHECK(near(after.rotation, before.rotation, {.absolute = 2 * rotation * in_step * in_step / 12}));
  if (dimension == 3) CHECK(after.position.z == 0);
}

}  // namespace scree
