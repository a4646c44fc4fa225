// Many explicit particles on a light body: it carries their weight, at the particles' step size.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kGravity = 9.81, kBodyMass = 0.1;  // [m/s^2], [kg]

std::string head(Real step, Real end, int substeps, Real friction) {
  return fmt::format(R"(
gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
leaving = "ballistic"
[time]
end = {}
step = {}
control = "fixed"
[integrator]
particles = "velocity-verlet"
substeps = {}
[output]
history_interval = 0.005
[[contact.pairs]]
stiffness = 1e5
restitution = 0.3
{}
)",
                     end, step, substeps, friction > 0 ? fmt::format("friction = {}", friction) : "");
}

// Particles in layers of side x side, each a little off its lattice position, above z.
std::string grains(int count, int side, Real radius, Real z, Real mass) {
  std::string positions;
  for (int i = 0; i < count; ++i) {
    const auto off = [&](int k) { return Real(0.1) * radius * std::sin(Real(7 * i + 3 * k)); };
    const auto at = [&](int k) { return Real(2.3) * radius * (k - Real(0.5) * (side - 1)); };
    positions += fmt::format("[{}, {}, {}], ", at(i % side) + off(0), at(i / side % side) + off(1),
                             z + Real(1.2) * radius + Real(2.3) * radius * (i / (side * side)) + off(2));
  }
  return fmt::format(
      "[[particles]]\nname = \"grains\"\nkind = \"list\"\nradius = {}\nmass = {}\npositions = [{}]\n", radius,
      mass, positions);
}

// An open box of two-sided meshes, with its body on a joint with the ground at the origin.
std::string bin(const std::string& joint, Real depth) {
  constexpr Real kEdge = 0.12, kHeight = 0.3;
  std::string deck =
      fmt::format("[[meshes]]\nname = \"floor\"\nkind = \"rectangle\"\nsize = [{0}, {0}]\n", kEdge);
  std::string meshes = "{ mesh = \"floor\" }";
  for (int side = 0; side < 4; ++side) {
    const Real x = side == 0 ? 1 : side == 1 ? -1 : 0, y = side == 2 ? 1 : side == 3 ? -1 : 0;
    deck += fmt::format(
        "[[meshes]]\nname = \"side{0}\"\nkind = \"rectangle\"\nsize = [{1}, {1}]\noffset = [{2}, {3}, {4}]\n"
        "z_axis = [{5}, {6}, 0.0]\n",
        side, kHeight, x * kEdge / 2, y * kEdge / 2, kHeight / 2, -x, -y);
    meshes += fmt::format(", {{ mesh = \"side{}\" }}", side);
  }
  return deck + fmt::format(R"(
[[bodies]]
name = "bin"
kind = "spatial"
mass = {0}
inertia_tensor = [4e-4, 4e-4, 4e-4, 0.0, 0.0, 0.0]
position = [0.0, 0.0, {1}]
meshes = [{2}]
[[joints]]
name = "hinge"
bodies = ["ground", "bin"]
local_points = [[0.0, 0.0, 0.0], [0.0, 0.0, {3}]]
{4}
)",
                            kBodyMass, -depth, meshes, depth, joint);
}

// Mean of read(sample) over the history samples in the second half of the run.
Real mean_of_second_half(SimulationRun& run, Real end, const std::function<Real()>& read) {
  Real sum = 0;
  int samples = 0;
  run.run([&] {
    if (run.time() > end / 2) sum += read(), ++samples;
  });
  return sum / samples;
}

Real weight(int count, Real mass) { return (count * mass + kBodyMass) * kGravity; }

struct Load {
  const char* name;
  const char* joint;
  int count, side;
  Real radius, mass, friction, step;
  int substeps;
  Real end;
};

constexpr const char* kRevolute =
    "type = \"revolute\"\naxis = [0.0, 1.0, 0.0]\n[[joint_springs]]\nname = \"damper\"\njoint = \"hinge\"\n"
    "stiffness = 0.0\ndamping = 0.05\nfree_coordinate = 0.0\n";

}  // namespace

// With the force at the predicted position alone the first, the third and the fifth of these become
// unstable.
TEST_CASE("particles in a light bin have their weight at its revolute joint") {
  for (const Load& load :
       {Load{"40 grains of 0.5 kg", kRevolute, 40, 3, 0.015, 0.5, 0, 1.2e-4, 1, 1.5},
        Load{"40 particles with friction", kRevolute, 40, 3, 0.015, 0.5, 0.4, 1e-4, 1, 1.5},
        Load{"40 grains of 10 kg", kRevolute, 40, 3, 0.015, 10, 0.3, 1.2e-4, 1, 2},
        Load{"100 grains", "type = \"fixed\"", 100, 4, 0.012, 0.2, 0.3, 1e-4, 1, 1},
        Load{"10 substeps", kRevolute, 40, 3, 0.015, 0.5, 0, 1.2e-4, 10, 1.2}}) {
    CAPTURE(load.name);
    SimulationRun run(model_of(head(load.step, load.end, load.substeps, load.friction) +
                               bin(load.joint, 0.3) +
                               grains(load.count, load.side, load.radius, -0.3, load.mass)));
    const Real mean = mean_of_second_half(
        run, load.end, [&] { return run.multibody().reactions(run.bodies(), run.time()).front().force.z; });
    const Real error = mean / weight(load.count, load.mass) - 1;
    std::cout << fmt::format("{} in a bin of 0.1 kg: the joint carries {:.5f} of their weight\n", load.name,
                             mean / weight(load.count, load.mass));
    CHECK(std::abs(error) <= 1e-3);
  }
}

TEST_CASE("heavy spheres come to rest on a light plate on a spring") {
  for (const Real mass : {0.5, 5.0})
    for (const int substeps : {1, 10}) {
      CAPTURE(mass, substeps);
      const Real end = 1;
      const std::string plate = fmt::format(R"(
[[meshes]]
name = "sheet"
kind = "rectangle"
size = [0.32, 0.32]
[[bodies]]
name = "plate"
kind = "spatial"
mass = {}
inertia_tensor = [1e-3, 1e-3, 2e-3, 0.0, 0.0, 0.0]
position = [0.0, 0.0, 0.0]
meshes = [{{ mesh = "sheet" }}]
[[joints]]
name = "guide"
type = "translational"
bodies = ["ground", "plate"]
local_points = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
axis = [0.0, 0.0, 1.0]
[[joint_springs]]
name = "spring"
joint = "guide"
stiffness = {}
damping = {}
free_coordinate = 0.0
)",
                                            kBodyMass, 1e4 * mass, 700 * mass);
      SimulationRun run(model_of(head(1e-4, end, substeps, 0) + plate + grains(16, 4, 0.03, 0, mass)));
      const Real mean = mean_of_second_half(run, end, [&] { return -run.bodies().wrench.front().force.z; });
      std::cout << fmt::format(
          "16 spheres of {} kg on a plate of 0.1 kg, {} substeps: {:.5f} of their weight\n", mass, substeps,
          mean / (16 * mass * kGravity));
      CHECK(std::abs(mean / (16 * mass * kGravity) - 1) <= 1e-3);
    }
}

// The difference between the particles' loss and the body's gain of momentum is of the order of the
// correction, which vanishes with the step.
TEST_CASE("heavy spheres that hit a light free plate keep the momentum of both") {
  const auto error = [](Real step) {
    const std::string plate = fmt::format(
        "[[meshes]]\nname = \"sheet\"\nkind = \"rectangle\"\nsize = [0.32, 0.32]\n[[bodies]]\nname = "
        "\"plate\"\n"
        "kind = \"spatial\"\nmass = {}\ninertia_tensor = [1e-3, 1e-3, 2e-3, 0.0, 0.0, 0.0]\n"
        "position = [0.0, 0.0, -0.01]\nmeshes = [{{ mesh = \"sheet\" }}]\n",
        kBodyMass);
    Model model = model_of(head(step, 0.02, 1, 0) + plate + grains(16, 4, 0.03, 0, 0.5),
                           {"gravity=[0.0, 0.0, 0.0]", "particles.0.velocity=[0.0, 0.0, -1.0]"});
    SimulationRun run(model);
    const auto momentum = [&] {
      const std::vector<Real>& v = run.bodies().velocity;
      return run.particle_ledger().momentum + kBodyMass * Vec3{v[0], v[1], v[2]};
    };
    const Vec3 start = momentum();
    run.run();
    REQUIRE(run.bodies().velocity[2] < -0.9);
    return norm(momentum() - start) / norm(start);
  };
  const Real coarse = error(1e-4), fine = error(1.25e-5), order = std::log2(coarse / fine) / 3;
  std::cout << fmt::format(
      "16 spheres of 0.5 kg hit a free plate of 0.1 kg: of the momentum {:.1e} appears or is lost at 0.1 ms, "
      "{:.1e} at 0.0125 ms, order {:.2f}\n",
      coarse, fine, order);
  CHECK(coarse <= 1e-4);
  CHECK(order >= 1.75);
}
