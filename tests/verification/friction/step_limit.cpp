// The step limit of a dense lattice with friction: rotation of all spheres alike, the fastest mode of stiff
// tangential springs, is stable below it and unstable above.
#include <fmt/format.h>

#include "model/checks/limits.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr int kCells = 3;  // cubes of the face-centred cubic lattice along each axis
constexpr Real kRadius = 0.05, kStiffness = 1e5, kMass = 1, kSpin = 1e-6;

// Pressed together by 0.1 % of the radius, so that rotations do not slide.
std::string lattice_deck(Real slip_stiffness, Real damping_ratio, Real step, int steps) {
  const Real edge = 2 * kRadius * Real(0.999) * std::sqrt(Real(2)), length = kCells * edge;
  std::string positions;
  for (int position = 0; position < kCells * kCells * kCells; ++position)
    for (const Vec3 corner : {Vec3{0, 0, 0}, Vec3{0.5, 0.5, 0}, Vec3{0.5, 0, 0.5}, Vec3{0, 0.5, 0.5}}) {
      const Vec3 p = edge * (corner + Vec3{static_cast<Real>(position % kCells),
                                           static_cast<Real>(position / kCells % kCells),
                                           static_cast<Real>(position / kCells / kCells)});
      positions += fmt::format("[{}, {}, {}], ", p.x, p.y, p.z);
    }
  std::string sides;
  for (const char* side : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    sides += fmt::format("{} = \"periodic\"\n", side);
  return fmt::format(R"(
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [{length}, {length}, {length}]
{sides}
[time]
end = {end}
step = {step}
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = {stiffness}
friction = 1.0
tangential_stiffness = {slip_stiffness}
tangential_damping_ratio = {damping_ratio}
[[particles]]
name = "lattice"
kind = "list"
positions = [{positions}]
radius = {radius}
mass = {mass}
angular_velocity = [{spin}, 0.0, 0.0]
)",
                     fmt::arg("length", length), fmt::arg("sides", sides), fmt::arg("end", steps * step),
                     fmt::arg("step", step), fmt::arg("stiffness", kStiffness),
                     fmt::arg("slip_stiffness", slip_stiffness), fmt::arg("damping_ratio", damping_ratio),
                     fmt::arg("positions", positions), fmt::arg("radius", kRadius), fmt::arg("mass", kMass),
                     fmt::arg("spin", kSpin));
}

// Largest spin within 200 steps, relative to the start. Instability ends in sliding.
Real growth(Model model, Real step) {
  model.time.step = step, model.time.end = 200 * step;
  SimulationRun run(model);
  Real largest = 0;
  while (run.time() < 199.5 * step) {
    run.step();
    for (const Particle& p : run.particles()) largest = std::max(largest, norm(p.angular_velocity));
  }
  return largest / kSpin;
}

}  // namespace

TEST_CASE("a dense lattice with friction is stable up to the stated step, and not beyond") {
  for (const Real damping_ratio : {0.0, 0.3}) {
    CAPTURE(damping_ratio);
    const Model model = model_of(lattice_deck(kStiffness, damping_ratio, 1e-5, 1));
    const std::vector<PairLimit> limits = pair_limits(model);
    REQUIRE(limits.size() == 1);
    if (damping_ratio == 0)
      CHECK(near(limits[0].explicit_step, 2 / std::sqrt(40 * kStiffness / kMass), {.relative = 4 * kUlp}));
    CHECK(growth(model, 0.98 * limits[0].explicit_step) < 3);
    CHECK(growth(model, 1.03 * limits[0].explicit_step) > 100);
    // The deck itself is refused.
    CHECK(model_error(lattice_deck(kStiffness, damping_ratio, 0.99 * limits[0].explicit_step, 1)).empty());
    CHECK(contains(model_error(lattice_deck(kStiffness, damping_ratio, 1.01 * limits[0].explicit_step, 1)),
                   "is unstable in dense contacts"));
  }
}

// Squares of the fastest frequencies: 16 k_t / (m f) of spins, 8 (K + k_t) / m of layers.
TEST_CASE("a small moment of inertia shortens the step in a dense lattice, a large one does not") {
  for (const auto& [factor, square] : {std::pair<Real, Real>{0.1, 160}, {1, 16}}) {
    CAPTURE(factor);
    const std::vector<std::string> settings{fmt::format("particles.lattice.inertia_factor={}", factor)};
    const Model model = model_of(lattice_deck(kStiffness, 0, 1e-5, 1), settings);
    const Real limit = pair_limits(model)[0].explicit_step;
    CHECK(near(limit, 2 / std::sqrt(square * kStiffness / kMass), {.relative = 4 * kUlp}));
    CHECK(growth(model, 0.98 * limit) < 3);
    CHECK(growth(model, 1.03 * limit) > 100);
  }
}

TEST_CASE("springs across the normal that are soft leave the limit to those along it") {
  const Model model = model_of(lattice_deck(kStiffness / 7, 0, 1e-5, 1));
  const Real limit = pair_limits(model)[0].explicit_step;
  CHECK(near(limit, 2 / std::sqrt(8 * kStiffness * (1 + Real(1) / 7) / kMass), {.relative = 4 * kUlp}));
  CHECK(growth(model, 0.98 * limit) < 3);
}

}  // namespace scree
