// Contact forces on walls and bodies in a history, against weights, lever arms and joint reactions in
// equilibrium.
#include <string>
#include <vector>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kGravity = 9.8066, kAtRest = 1e-8;

std::string deck_in_box(const std::string& end) {
  return R"(
gravity = [0.0, -9.8066]
[space]
dimension = 2
min = [-1.0, -0.5]
max = [1.0, 1.0]
y_min = "wall"
[time]
step = 1e-4
control = "fixed"
end = )" +
         end + "\n[[contact.pairs]]\nstiffness = 1e6\ndamping = 2000.0\n";
}

// A wall in the middle of the domain carries three discs.
const std::string kColumn = deck_in_box("0.4") + R"(
[[walls]]
name = "floor"
point = [-0.4, 0.1]
normal = [0.0, 2.0]
[[particles]]
name = "discs"
kind = "row"
origin = [0.2, 0.15]
spacing = [0.0, 0.1]
count = 3
radius = 0.05
mass = 2.0
[output]
history_contacts = ["floor", "y_min"]
)";

// Two tables, held at their centres, a disc between two circles of the second; and a cart on the floor that
// carries a disc.
const std::string kBodies = deck_in_box("0.6") + R"(
[[bodies]]
name = "table"
count = 2
position = [-0.7, 0.3]
spacing = [0.4, 0.1]
mass = 3.0
inertia = 0.1
shapes = [{ offset = [0.14, 0.0], radius = 0.05 }, { offset = [0.26, 0.0], radius = 0.05 }]
[[bodies]]
name = "cart"
position = [0.5, -0.4501]
mass = 5.0
inertia = 0.1
shapes = [{ offset = [-0.06, 0.0], radius = 0.05 }, { offset = [0.06, 0.0], radius = 0.05 }]
[[joints]]
name = "post"
type = "fixed"
each = "table"
[[particles]]
name = "loads"
kind = "list"
positions = [[-0.1, 0.48], [0.5, -0.3701]]
radius = 0.05
mass = 2.0
[output]
history_contacts = ["table.0", "table.1", "table", "cart", "y_min"]
)";

// A particle, and a ball that is a body, each on a tray of a beam; both trays are meshes.
const std::string kTrays = R"(
gravity = [0.0, 0.0, -9.8066]
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
end = 1.0
step = 1e-4
control = "fixed"
[integrator]
particles = "hht"
residual_tolerance = 1e-11
[[contact.pairs]]
stiffness = 1e5
damping = 400.0
[[meshes]]
name = "tray"
kind = "box"
size = [0.2, 0.2, 0.02]
[[meshes]]
name = "other"
kind = "box"
size = [0.2, 0.2, 0.02]
offset = [-0.5, 0.0, 0.0]
[[bodies]]
name = "beam"
kind = "spatial"
position = [0.2, 0.0, 0.0]
mass = 3.0
inertia_tensor = [0.1, 0.1, 0.1, 0.0, 0.0, 0.0]
meshes = [{ mesh = "tray" }, { mesh = "other" }]
[[bodies]]
name = "ball"
kind = "spatial"
position = [0.2, 0.0, 0.0599]
mass = 1.0
inertia_tensor = [0.001, 0.001, 0.001, 0.0, 0.0, 0.0]
shapes = [{ radius = 0.05 }]
[[joints]]
name = "post"
type = "fixed"
bodies = ["ground", "beam"]
[[particles]]
name = "grain"
kind = "list"
positions = [[-0.3, 0.0, 0.0599]]
radius = 0.05
mass = 2.0
[output]
history_contacts = ["beam", "beam.tray", "beam.other"]
)";

const std::vector<std::string> kIntegrators = {"integrator.particles=hht",
                                               "integrator.particles=velocity-verlet"};

// The history's columns of the target with this number in the list: force, torque, contacts.
struct Recorded {
  Vec3 force, torque;
  Real contacts;
};

Recorded recorded(const std::vector<Real>& values, std::size_t target) {
  const Real* v = values.data() + 7 * target;
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
}

void check(const Recorded& found, Vec3 force, Real torque, Real contacts) {
  CAPTURE(found.force.x, found.force.y, found.torque.z, found.contacts);
  CHECK(norm(found.force - force) <= kAtRest * (1 + norm(force)));
  CHECK(norm(found.torque - Vec3{0, 0, torque}) <= kAtRest * (1 + std::abs(torque)));
  CHECK(found.contacts == contacts);
}

}  // namespace

TEST_CASE("a static column presses on the wall with its weight") {
  for (const std::string& integrator : kIntegrators) {
    CAPTURE(integrator);
    SimulationRun run(model_of(kColumn, {integrator}));
    run.run();
    const std::vector<Real> values = run.contact_values();
    const Real weight = 3 * 2.0 * kGravity;
    check(recorded(values, 0), {0, -weight, 0}, -0.6 * weight, 1);
    check(recorded(values, 1), {}, 0, 0);
  }
}

TEST_CASE("static bodies carry the particles on them, and press on walls with both weights") {
  for (const std::string& integrator : kIntegrators) {
    CAPTURE(integrator);
    SimulationRun run(model_of(kBodies, {integrator}));
    run.run();
    const std::vector<Real> values = run.contact_values();
    const Real load = 2.0 * kGravity, cart = 5.0 * kGravity;
    check(recorded(values, 0), {}, 0, 0);
    check(recorded(values, 1), {0, -load, 0}, -0.2 * load, 2);
    check(recorded(values, 2), {0, -load, 0}, 0.1 * load, 2);  // about the origin
    check(recorded(values, 3), {0, cart, 0}, 0, 4);
    check(recorded(values, 4), {0, -load - cart, 0}, -1.5 * (load + cart), 2);

    const std::vector<Reaction> reactions = run.multibody().reactions(run.bodies(), run.time());
    REQUIRE(reactions.size() == 2);
    const Recorded table = recorded(values, 1);
    const Reaction& post = reactions[1];
    CHECK(keeps(norm(post.force + table.force - Vec3{0, 3.0 * kGravity, 0}),
                {.promise = kAtRest, .measured = 2e-14}));
    CHECK(keeps(post.torque.z + table.torque.z, {.promise = kAtRest, .measured = 1e-15}));
  }
}

TEST_CASE("the contacts of each mesh of a body are counted separately") {
  for (const std::string& integrator : kIntegrators) {
    CAPTURE(integrator);
    SimulationRun run(model_of(kTrays, {integrator}));
    run.run();
    const std::vector<Real> values = run.contact_values();
    const Real ball = 1.0 * kGravity, grain = 2.0 * kGravity;
    const auto check_mesh = [&](std::size_t target, Real force, Vec3 torque, Real contacts) {
      const Recorded on = recorded(values, target);
      CAPTURE(target, on.force.z, on.torque.y, on.contacts);
      CHECK(norm(on.force - Vec3{0, 0, -force}) <= kAtRest * (1 + force));
      CHECK(norm(on.torque - torque) <= kAtRest * (1 + norm(torque)));
      CHECK(on.contacts == contacts);
    };
    check_mesh(0, ball + grain, {0, -0.5 * grain, 0}, 2);
    check_mesh(1, ball, {}, 1);
    check_mesh(2, grain, {0, -0.5 * grain, 0}, 1);
  }
}

}  // namespace scree
