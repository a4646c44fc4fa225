// Dissipation of contacts at triangles, against the particles' own, closed forms and restarts.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "dem/reports/triangle_works.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "verification/surfaces/particles.hpp"

namespace scree {

namespace {

constexpr Real kBalance = 1e-12, kWear = 3e-12;  // [-], [1/Pa]
constexpr Real kGravity = 9.81, kRadius = 0.02, kDensity = 2500, kFriction = 0.3, kStiffness = 1e4;

const std::string kFloor =
    "surface_fields = [\"impact_work\", \"sliding_work\", \"wear_depth\"]\n[[meshes]]\nname = "
    "\"floor\"\nkind "
    "= \"rectangle\"\nsize = [4.0, 4.0]\nrefine = 0.11\n[[walls]]\nname = \"floor\"\nmesh = \"floor\"\n";
const std::string kWears = fmt::format("contact.pairs.0.wear_coefficient={}", kWear);

Real mass() { return 4 * M_PI / 3 * kRadius * kRadius * kRadius * kDensity; }

// Sums over all triangles.
TriangleWorkValues sums_of(const State& state) {
  TriangleWorkValues sum{};
  for (const TriangleWorkValues& of : work_values(state.works))
    sum.impact += of.impact, sum.sliding += of.sliding, sum.worn += of.worn;
  return sum;
}

std::string thrown_particle(Real height, const std::string& velocity) {
  return sliding_grain(fmt::format("[0.013, 0.0, {:.17g}]", height), velocity,
                       fmt::format("[0.0, 0.0, {}]", -kGravity)) +
         kFloor;
}

struct Method {
  std::string name;
  std::vector<std::string> settings;
};
const std::vector<Method> kMethods = {
    {"explicit", {}},
    {"implicit", {"integrator.particles=hht"}},
    {"adaptive", {"integrator.particles=hht", "time.control=adaptive", "time.tolerance=1e-6"}}};

std::vector<std::string> with(std::vector<std::string> settings, const std::vector<std::string>& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

}  // namespace

TEST_CASE("the dissipation of all triangles is that of a particle that bounces, slides and rolls") {
  for (const Method& method : kMethods) {
    SimulationRun run(model_of(thrown_particle(0.05, "[0.9, 0.3, -0.5]"), with(method.settings, {kWears})));
    for (const Real t : {0.05, 0.11, 0.3, 0.8}) {
      run.run_until(t);
      const State& state = run.complete_state();
      const Particle& grain = state.particles.at(0);
      const TriangleWorkValues sum = sums_of(state);
      CAPTURE(method.name, t);
      CHECK(sum.impact > 0.01 * mass());
      CHECK(sum.sliding > 0.01 * mass());
      CHECK(near(sum.impact + sum.sliding, grain.contact_loss, {.relative = kBalance}));
      CHECK(near(sum.sliding, grain.friction_loss, {.relative = kBalance}));
      CHECK(near(sum.worn, kWear / kFriction * sum.sliding, {.relative = kBalance}));
    }
    if (method.name == "adaptive") CHECK(run.counts().rejected_error > 0);
  }
}

// In two parts, between which the run is continued from its state.
TEST_CASE("the dissipation of all triangles is that of a body's sphere that bounces, slides and rolls") {
  for (const Method& method : kMethods) {
    CAPTURE(method.name);
    const Real inertia = 0.4 * mass() * kRadius * kRadius;
    const std::string ball = fmt::format(
        "[[bodies]]\nname = \"ball\"\nkind = \"spatial\"\nposition = [0.013, 0, 0.05]\nvelocity = [0.9, 0.3, "
        "-0.5]\nmass = {:.17g}\ninertia_tensor = [{:.17g}, {:.17g}, {:.17g}, 0, 0, 0]\nshapes = [{{ radius = "
        "{} }}]\n",
        mass(), inertia, inertia, inertia, kRadius);
    std::string deck = thrown_particle(0.05, "[0.9, 0.3, -0.5]");
    const std::size_t grain = deck.find("[[particles]]");
    deck.replace(grain, deck.find("[output]") - grain, ball);
    const Model model = model_of(deck, with(method.settings, {kWears}));
    SimulationRun run(model);
    run.run_until(0.11);
    SimulationRun onward(model, run.complete_state());
    onward.run_until(0.8);
    const State& state = onward.complete_state();
    const TriangleWorkValues sum = sums_of(state);
    CHECK(sum.impact > 0.01 * mass());
    CHECK(sum.sliding > 0.01 * mass());
    CHECK(near(sum.impact + sum.sliding, state.shapes.contact_loss, {.relative = kBalance}));
    CHECK(near(sum.sliding, state.shapes.tangential.of[kFrictionLoss], {.relative = kBalance}));
    CHECK(near(sum.worn, kWear / kFriction * sum.sliding, {.relative = kBalance}));
  }
}

// The dissipation of particles without rotation is trapezoidal: it lacks half of the end of the last step.
TEST_CASE("without friction the dissipation of an impact is the particle's and that of the last half step") {
  for (const std::string method : {"velocity-verlet", "hht"}) {
    const std::string smooth =
        "gravity = [0.0, 0.0, -9.81]\n[space]\ndimension = 3\nmin = [-2.0, -2.0, -2.0]\nmax = [2.0, 2.0, "
        "2.0]\n[time]\nend = 0.4\nstep = 8e-5\ncontrol = \"fixed\"\n[integrator]\nparticles = \"" +
        method +
        "\"\n[[contact.pairs]]\nstiffness = 1e4\nrestitution = 0.5\n[[particles]]\nname = \"grain\"\nkind = "
        "\"list\"\npositions = [[0.013, 0.0, 0.1]]\nradius = 0.02\ndensity = "
        "2500.0\n[output]\nsurface_fields = [\"impact_work\", \"sliding_work\"]\n[[meshes]]\nname = "
        "\"floor\"\nkind = \"rectangle\"\nsize = [4.0, 4.0]\n[[walls]]\nname = \"floor\"\nmesh = \"floor\"\n";
    SimulationRun run(model_of(smooth));
    Real most_open = 0;
    for (Real t = 0.1; t <= 0.4; t += 4e-4) {
      run.run_until(t);
      const State& state = run.complete_state();
      const Particle& grain = state.particles.at(0);
      const Real open = method == "hht" ? 0 : 8e-5 / 2 * grain.loss_power;
      most_open = std::max(most_open, open);
      CHECK(near(sums_of(state).impact, grain.contact_loss + open, {.relative = kBalance}));
      CHECK(sums_of(state).sliding == 0);
    }
    CAPTURE(method);
    CHECK((most_open > 0) == (method != "hht"));
  }
}

// The heights before and after the impact are those of the energies.
TEST_CASE("the impact work of a dropped particle is the height that it loses") {
  for (const Method& method : kMethods) {
    CAPTURE(method.name);
    const Real height = 0.1;
    SimulationRun run(model_of(thrown_particle(height, "[0.0, 0.0, 0.0]"),
                               with(method.settings, {kWears, "time.step=2e-5", "time.end=0.2"})));
    run.run_until(0.17);  // moving up
    const State& state = run.complete_state();
    const Particle& grain = state.particles.at(0);
    REQUIRE(grain.velocity.z > 0);
    const Real top = grain.position.z + grain.velocity.z * grain.velocity.z / (2 * kGravity);
    REQUIRE(top < 0.6 * height);
    CHECK(near(sums_of(state).impact, mass() * kGravity * (height - top), {.relative = 2e-3}));
  }
}

TEST_CASE("a particle thrown along a floor loses a seventh of m v^2 to friction, with wear K F s") {
  const Real overlap = mass() * kGravity / kStiffness, v = 0.8;
  SimulationRun run(model_of(thrown_particle(kRadius - overlap, fmt::format("[{}, 0.0, 0.0]", v)), {kWears}));
  run.run_until(0.01);
  const Real start = run.time();
  const Particle first = run.complete_state().particles.at(0);
  const TriangleWorkValues before = sums_of(run.complete_state());
  run.run_until(0.06);  // it slides until 2 v / (7 mu g) = 0.078 s
  const Real end = run.time();
  const Particle second = run.complete_state().particles.at(0);
  const TriangleWorkValues after = sums_of(run.complete_state());
  // It rotates about y with constant angular acceleration.
  const Real turned = (end - start) * (first.angular_velocity.y + second.angular_velocity.y) / 2;
  const Real slip = second.position.x - first.position.x - kRadius * turned;
  CHECK(slip > 0.01);
  const Real slid = mass() * kGravity * slip;
  CHECK(near(after.sliding - before.sliding, kFriction * slid, {.relative = 1e-9}));
  CHECK(near(after.worn - before.worn, kWear * slid, {.relative = 1e-9}));
  run.run();
  CHECK(near(sums_of(run.complete_state()).sliding, mass() * v * v / 7, {.relative = 2e-3}));
}

TEST_CASE("works continue after a restart with the bits of an uninterrupted run") {
  for (const std::string method : {"velocity-verlet", "hht"}) {
    const Model model = model_of(falling_grains(method) + kFloor, {kWears, "meshes.floor.refine=0.03"});
    SimulationRun whole(model), first(model);
    whole.run(), first.run_until(0.05);
    const State half = first.complete_state();
    SimulationRun second(model, half);
    second.run();
    const std::vector<std::int64_t>&at_half = half.works, &at_end = second.complete_state().works;
    CHECK(sums_of(half).sliding > 0);
    CHECK(at_half != at_end);
    CHECK(at_end == whole.complete_state().works);
  }
}

TEST_CASE("a floor without requested fields has no works") {
  SimulationRun run(
      model_of(thrown_particle(0.05, "[0.9, 0.3, -0.5]"), {"output.surface_fields=[\"pressure\"]"}));
  run.run();
  CHECK(run.complete_state().works.empty());
}

}  // namespace scree
