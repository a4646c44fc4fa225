// Heaps: an undisturbed one does not creep, and both sides of every contact of a shaken one stay mirrored.
#include <fmt/format.h>

#include <cmath>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/contact_record.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/particle_bits.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 0.02, kStep = 1e-4;  // [m], [s]

// Discs or spheres that fall into a heap on a floor between walls.
std::string heap_deck(int dimension, int count, Real end, const std::string& keys) {
  const std::string zero = dimension == 2 ? "" : ", 0.0";
  return fmt::format(R"(
gravity = [0.0, -9.81{zero}]
[space]
dimension = {dimension}
min = [0.0, 0.0{zero}]
max = [0.3, 1.0{depth}]
x_min = "wall"
x_max = "wall"
y_min = "wall"
{sides}
[time]
end = {end}
step = {step}
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 2e4
friction = 0.5
{keys}
[[particles]]
name = "heap"
kind = "random"
count = {count}
min = [0.0, 0.0{zero}]
max = [0.3, 0.4{depth}]
radius = {{ kind = "uniform", min = 0.014, max = {radius} }}
density = 2500.0
{thickness}
random_velocity = 0.3
angular_velocity = [{spin}]
seed = 7
)",
                     fmt::arg("zero", zero), fmt::arg("dimension", dimension),
                     fmt::arg("depth", dimension == 2 ? "" : ", 0.15"), fmt::arg("end", end),
                     fmt::arg("sides", dimension == 2 ? "" : "z_min = \"wall\"\nz_max = \"wall\""),
                     fmt::arg("step", kStep), fmt::arg("keys", keys), fmt::arg("count", count),
                     fmt::arg("radius", kRadius), fmt::arg("spin", dimension == 2 ? "5.0" : "5.0, 1.0, 2.0"),
                     fmt::arg("thickness", dimension == 2 ? "thickness = 0.05" : ""));
}

Real largest_move(const std::vector<Particle>& a, const std::vector<Particle>& b) {
  Real largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i].position - b[i].position));
  return largest;
}

}  // namespace

// With discs: spheres without resistance to rolling and twisting continue to roll on the floor and to spin
// on top.
TEST_CASE("a heap of discs that has come to rest by friction does not creep in 1e5 steps") {
  Real step = kStep, stirred = 1e-23;  // [J]: implicit steps leave residuals
  std::vector<std::string> settings;
  std::string keys = "damping = 20.0\ntangential_damping_ratio = 0.5\n";
  SECTION("explicit ones") {}
  SECTION("implicit ones, with rolling resistance") {
    step = 5 * kStep, stirred = 7e-19, keys += "rolling_friction = 0.1\nrolling_damping_ratio = 0.3\n";
    settings = {"integrator.particles=hht", "time.control=fixed", fmt::format("time.step={}", step)};
  }
  SECTION("implicit ones") {
    step = 5 * kStep, stirred = 7e-19;
    settings = {"integrator.particles=hht", "time.control=fixed", fmt::format("time.step={}", step)};
  }
  constexpr Real kSettled = 6;
  const Real alone = 1e5 * step;
  SimulationRun run(model_of(heap_deck(2, 60, kSettled + alone, keys), settings));
  run.run_until(kSettled);
  const std::vector<Particle> before = run.particles();
  const ParticleLedger settled = run.particle_ledger();
  REQUIRE(settled.contacts > 90);
  run.run();
  const ParticleLedger now = run.particle_ledger();
  CHECK(now.contacts == settled.contacts);
  CHECK(measured(
      "left_alone/move", "diameters",
      keeps(largest_move(run.particles(), before) / (2 * kRadius), {.promise = 1e-9, .measured = 5e-12})));
  CHECK(keeps(now.kinetic, {.promise = 1e-16, .measured = stirred}));  // a weight times its radius is 1e-2 J
  CHECK(now.contact_loss - settled.contact_loss < 1e-15);
}

// Three separate spheres under a fourth: each touches two others, about whose line it can roll. The pile
// continues to roll with what remains of its fall, and gains no energy from then on.
TEST_CASE("a pile of spheres that nothing keeps from rolling gains no motion in 1e5 implicit steps") {
  for (const Real alpha : {0.0, -0.05, -0.3}) {
    CAPTURE(alpha);
    constexpr Real kSettled = 5, kImplicit = 5 * kStep;
    const Real out = 0.045 / std::sqrt(Real(3)), top = kRadius + std::sqrt(4 * kRadius * kRadius - out * out);
    SimulationRun run(model_of(fmt::format(R"(
gravity = [0.0, -9.81, 0.0]
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [0.2, 0.2, 0.2]
y_min = "wall"
[time]
end = {end}
step = {step}
control = "fixed"
[integrator]
particles = "hht"
hht_alpha = {alpha}
[[contact.pairs]]
stiffness = 2e4
damping = 20.0
friction = 0.5
tangential_damping_ratio = 0.5
[[particles]]
kind = "list"
positions = [[{far}, 0.02, 0.1], [{near}, 0.02, 0.1225], [{near}, 0.02, 0.0775], [0.1, {top}, 0.1]]
radius = {radius}
density = 2500.0
)",
                                           fmt::arg("end", kSettled + 1e5 * kImplicit),
                                           fmt::arg("step", kImplicit), fmt::arg("alpha", alpha),
                                           fmt::arg("radius", kRadius), fmt::arg("far", 0.1 + out),
                                           fmt::arg("near", 0.1 - out / 2), fmt::arg("top", top))));
    run.run_until(kSettled);
    const std::vector<Particle> before = run.particles();
    REQUIRE(run.particle_ledger().contacts == 6);
    run.run_until(kSettled + 5e4 * kImplicit);
    const std::vector<Particle> half_way = run.particles();
    run.run();
    const std::vector<Particle> after = run.particles();
    CHECK(run.particle_ledger().contacts == 6);
    std::vector<Particle> evenly = before;  // half way at constant velocity
    for (std::size_t i = 0; i < evenly.size(); ++i)
      evenly[i].position = Real(0.5) * (before[i].position + after[i].position);
    const Real gained = 2 * largest_move(half_way, evenly) / (2 * kRadius);
    CHECK(measured("left_alone/rolling", "diameters", keeps(gained, {.promise = 1e-9, .measured = 2e-13})));
    if (alpha > -0.1)
      CHECK(keeps(largest_move(after, before) / (2 * kRadius), {.promise = 1e-9, .measured = 3.3e-10}));
  }
}

TEST_CASE("both sides of every contact mirror each other after 1e5 steps of a shaken heap") {
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    constexpr int kParts = 50;
    constexpr Real kPart = 2000 * kStep;
    Model model = model_of(heap_deck(dimension, 40, kParts * kPart, "damping = 1.0"));
    auto run = std::make_unique<SimulationRun>(model);
    std::int64_t contacts = 0;
    Real loss = 0;
    for (int part = 1; part <= kParts; ++part) {
      run->run_until(part * kPart);
      State state = run->complete_state();
      CHECK(unmirrored<3>(state.particles, state.contacts) == 0);
      contacts += std::ssize(state.contacts.keys);
      CHECK(run->particle_ledger().contact_loss > loss);
      loss = run->particle_ledger().contact_loss;
      // Gravity oscillates: the heap slides, rolls and falls from wall to wall.
      model.gravity = {part % 2 == 0 ? 15.0 : -15.0, -9.81, dimension == 3 ? 3.0 : 0.0};
      run = std::make_unique<SimulationRun>(model, state);
    }
    CHECK(contacts > 20 * kParts);
  }
}

}  // namespace scree
