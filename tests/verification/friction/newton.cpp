// Newton iterations of implicit steps in a pack with friction, against those without. With -s the test
// prints them, and with SCREE_MEASURED it writes the numbers of src/dem/README.md.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kStiffness = 1e4, kDensity = 2500, kRadius = 0.01;

// Spheres that fall and slide on a floor, half of their contacts sliding, undamped; phase_squared: sqrt(2 K /
// m) h; keys: of the pair.
StepCounts counts_of(Real phase_squared, const std::string& keys) {
  const Real mass = kDensity * 4 / 3 * std::numbers::pi_v<Real> * kRadius * kRadius * kRadius;
  SimulationRun run(model_of(fmt::format(
      R"(
gravity = [2.0, 0.0, -9.81]
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [0.126, 0.126, 0.3]
x_min = "periodic"
x_max = "periodic"
y_min = "periodic"
y_max = "periodic"
z_min = "wall"
[time]
end = 0.4
step = {step}
control = "fixed"
[integrator]
particles = "hht"
hht_alpha = -0.3
residual_tolerance = 1e-9
[[contact.pairs]]
stiffness = {stiffness}
{keys}
[[particles]]
name = "pack"
kind = "lattice"
origin = [0.0105, 0.0105, 0.011]
spacing = [0.021, 0.021, 0.0205]
size = [6, 6, 6]
radius = {radius}
density = {density}
random_velocity = 0.1
seed = 3
)",
      fmt::arg("step", phase_squared / std::sqrt(2 * kStiffness / mass)), fmt::arg("stiffness", kStiffness),
      fmt::arg("radius", kRadius), fmt::arg("density", kDensity), fmt::arg("keys", keys))));
  run.run();
  return run.counts();
}

Real per_step(std::int64_t count, const StepCounts& counts) {
  return static_cast<Real>(count) / static_cast<Real>(counts.steps);
}

}  // namespace

TEST_CASE("Newton iterations of a pack with friction") {
  struct Expected {
    // Iterations per step, without friction, with it, and with rolling resistance too.
    Real phase_squared, frictionless, frictional, rolling;
    bool freezes;
  };
  for (const Expected& e : {Expected{0.63, 5.0, 4.5, 4.6, false}, Expected{1.2, 6.0, 5.4, 5.7, false},
                            Expected{1.9, 6.9, 6.5, 6.7, false}, Expected{6.3, 11.7, 44, 44, true}}) {
    const StepCounts frictionless = counts_of(e.phase_squared, ""),
                     frictional = counts_of(e.phase_squared, "friction = 0.5"),
                     rolling = counts_of(e.phase_squared, "friction = 0.5\nrolling_friction = 0.1");
    const Real newton[3] = {per_step(frictionless.newton_iterations, frictionless),
                            per_step(frictional.newton_iterations, frictional),
                            per_step(rolling.newton_iterations, rolling)};
    INFO(fmt::format(
        "sqrt(2K/m) h = {}: {:.1f} Newton iterations per step without friction, {:.1f} with it, {:.2f} with "
        "rolling resistance ({} of {} steps lagged, {} rejected); {:.0f} "
        "and {:.0f} products; limits frozen in {} of {} steps, {} steps rejected",
        e.phase_squared, newton[0], newton[1], newton[2], rolling.lagged_steps, rolling.steps,
        rolling.rejected_newton, per_step(frictionless.linear_iterations, frictionless),
        per_step(frictional.linear_iterations, frictional), frictional.lagged_steps, frictional.steps,
        frictional.rejected_newton));
    const std::string phase_squared = fmt::format("{}", e.phase_squared);
    CHECK(measured("newton/" + phase_squared + ", slick", "", at_most(newton[0], 1.1 * e.frictionless)));
    CHECK(measured("newton/" + phase_squared + ", frictional", "", at_most(newton[1], 1.1 * e.frictional)));
    CHECK(measured("newton/" + phase_squared + ", rolling", "", at_most(newton[2], 1.1 * e.rolling)));
    note("newton/" + phase_squared + ", products", "", per_step(frictional.linear_iterations, frictional));
    note("newton/" + phase_squared + ", frozen", "%", per_step(100 * frictional.lagged_steps, frictional));
    note("newton/" + phase_squared + ", rejected", "%",
         per_step(100 * frictional.rejected_newton, frictional));
    CHECK((frictional.lagged_steps > 0) == e.freezes);
  }
}

// A separated particle has ever smaller accelerations, finally beyond the range of single precision.
TEST_CASE("a sphere that rebounds from a wall with friction needs few products") {
  SimulationRun run(model_of(R"(
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [10.0, 10.0, 10.0]
x_min = "wall"
[time]
end = 0.2
step = 1e-4
control = "fixed"
[integrator]
particles = "hht"
hht_alpha = -0.3
[[contact.pairs]]
stiffness = 1e4
friction = 0.5
[[particles]]
name = "one"
kind = "lattice"
origin = [0.0102, 5.0, 5.0]
spacing = [0.021, 0.021, 0.021]
size = [1, 1, 1]
velocity = [-1.0, 1.0, 0.0]
radius = 0.01
density = 2500
)"));
  run.run();
  const StepCounts counts = run.counts();
  CHECK(counts.steps > 1000);
  CHECK(counts.linear_iterations < counts.newton_iterations);
}

}  // namespace scree
