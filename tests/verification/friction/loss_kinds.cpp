// Parts of friction, rolling and twisting in the dissipation of contacts, through decks: against closed
// forms, and against the total.
#include <fmt/format.h>

#include "physics/energy.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/friction/plane_run.hpp"

namespace scree {

namespace {

constexpr Real kMass = 0.1, kRadius = 0.02, kSpeed = 1;

// Dissipation since t = 0, that of escaped particles included [J].
TangentialLosses losses_of(SimulationRun& run) {
  TangentialLosses out = run.particle_ledger().rotation.losses;
  out.add(run.complete_state().carried_out.losses);
  return out;
}
Real sum_of(const TangentialLosses& losses) {
  return losses.of[kFrictionLoss] + losses.of[kRollingLoss] + losses.of[kTwistingLoss];
}
Real dissipated(SimulationRun& run) { return run.ledger().dissipated_contacts; }

Real energy_of(const Particle& p) {
  return kinetic_energy(p.mass, p.velocity) + rotational_energy(p.moment_of_inertia, p.angular_velocity);
}

// 2/7 of the kinetic energy is dissipated in sliding, with the dashpot also the remaining energy of the
// spring.
Real sliding_error(Real step, const std::vector<std::string>& settings) {
  const Grain grain{.velocity = {kSpeed, 0, 0}, .radius = kRadius, .mass = kMass};
  SimulationRun run(resting_model(grain, 0.3, 1e5, 0.2, inclined_gravity(0), step, 0.3, settings));
  run.run();
  const TangentialLosses losses = losses_of(run);
  CHECK(near(losses.of[kFrictionLoss], dissipated(run), {.relative = 1e-12}));
  CHECK((losses.of[kRollingLoss] == 0 && losses.of[kTwistingLoss] == 0));
  return losses.of[kFrictionLoss] / (kMass * kSpeed * kSpeed / 7) - 1;
}

// A sphere on the wall z = 0 whose weight its spring carries.
SimulationRun run_on_wall(const std::string& law, Vec3 velocity, Vec3 spin, Real step, Real end) {
  Grain grain{.velocity = velocity, .spin = spin, .radius = kRadius, .mass = kMass};
  const Vec3 gravity = inclined_gravity(0);
  grain.position = {0, 0, kRadius + kMass * gravity.z / kRestStiffness};
  GrainDeck deck{
      .law =
          fmt::format("stiffness = {}\nfriction = 0.5\ntangential_stiffness = 8e4\n", kRestStiffness) + law,
      .grains = {grain},
      .step = step,
      .end = end};
  deck.gravity = gravity;
  return SimulationRun(deck.model());
}

// Agitated spheres between walls that escape through one side. friction_keys: keys of the pair.
Model escaping_model(const std::string& friction_keys, const std::vector<std::string>& settings) {
  return model_of(R"(
[space]
dimension = 3
min = [-0.25, -0.25, -0.25]
max = [0.25, 0.25, 0.25]
x_min = "wall"
y_min = "wall"
y_max = "wall"
z_min = "periodic"
z_max = "periodic"
leaving = "remove"
[time]
end = 0.1
step = 5e-5
[integrator]
particles = "velocity-verlet"
[output]
history_interval = 2e-3
[[contact.pairs]]
stiffness = 2e5
friction = 0.4
)" + friction_keys + R"(
[[particles]]
name = "cloud"
kind = "random"
count = 120
min = [-0.25, -0.25, -0.25]
max = [0.25, 0.25, 0.25]
radius = { kind = "uniform", min = 0.02, max = 0.04 }
density = 2500.0
random_velocity = 2.0
angular_velocity = [30.0, -20.0, 10.0]
seed = 11
)",
                  settings);
}

}  // namespace

TEST_CASE("a slide until a sphere rolls loses two sevenths of its energy, all to friction") {
  CHECK(keeps(sliding_error(1e-5, {}), {.promise = 1e-3, .measured = 1e-4}));
  for (const Real alpha : {0.0, -0.3})
    CHECK(keeps(sliding_error(5e-5, implicit_steps(alpha)), {.promise = 1e-6, .measured = 2e-8}));
}

TEST_CASE("a sphere that rolls until it rocks loses its energy to rolling, but for what its slip damps") {
  SimulationRun run =
      run_on_wall("tangential_damping_ratio = 0.3\nrolling_friction = 0.1\nrolling_damping_ratio = 0.3\n",
                  {0.3, 0, 0}, {0, 0.3 / kRadius, 0}, 1e-5, 0.6);
  const Real start = energy_of(run.particles()[0]);
  run.run();
  const TangentialLosses losses = losses_of(run);
  CHECK(energy_of(run.particles()[0]) < 1e-9 * start);
  CHECK(near(sum_of(losses), dissipated(run), {.relative = 1e-12}));
  CHECK(keeps((losses.of[kRollingLoss] + losses.of[kFrictionLoss]) / start - 1,
              {.promise = 1e-3, .measured = 2.3e-5}));
  CHECK(losses.of[kFrictionLoss] > 0);
  CHECK(losses.of[kFrictionLoss] < 1e-2 * losses.of[kRollingLoss]);
  CHECK(losses.of[kTwistingLoss] == 0);
}

TEST_CASE("a moment against the rate of rolling takes all of it") {
  SimulationRun run = run_on_wall("rolling_damping = 2e-4\n", {0.3, 0, 0}, {0, 0.3 / kRadius, 0}, 2e-5, 0.2);
  const Real start = energy_of(run.particles()[0]);
  run.run();
  const TangentialLosses losses = losses_of(run);
  CHECK(losses.of[kRollingLoss] > 0.2 * start);
  CHECK(near(losses.of[kRollingLoss], start - energy_of(run.particles()[0]), {.relative = 2e-3}));
}

TEST_CASE("a sphere that spins about the vertical loses its energy to twisting alone") {
  const Real spin = 20;
  SimulationRun run =
      run_on_wall("tangential_damping_ratio = 0.3\ntwisting_friction = 0.5\n", {}, {0, 0, spin}, 1e-5, 2.6);
  const Real start = energy_of(run.particles()[0]);
  run.run();
  const TangentialLosses losses = losses_of(run);
  const Real swings = energy_of(run.particles()[0]) + run.particle_ledger().rotation.rolling_springs;
  CHECK(swings < 2e-3 * start);
  CHECK(keeps((losses.of[kTwistingLoss] + swings) / start - 1, {.promise = 1e-3, .measured = 2e-6}));
  CHECK(near(losses.of[kTwistingLoss], dissipated(run), {.relative = 1e-12}));
  CHECK((losses.of[kFrictionLoss] == 0 && losses.of[kRollingLoss] == 0));
}

// Without normal damping the parts are the total. With a damper they are the rest beside it.
TEST_CASE("the kinds add up to what contacts dissipate, of particles that leave, too") {
  const std::vector<std::string> hht = {"integrator.particles=hht", "time.control=fixed"};
  const std::string rolling = "rolling_friction = 0.2\nrolling_damping = 1e-3\ntwisting_friction = 0.3\n";
  struct Case {
    std::string friction_keys;
    std::vector<std::string> settings;
  };
  for (const auto& [friction_keys, settings] :
       {Case{"tangential_damping_ratio = 0.2\n", {}}, Case{"tangential_damping_ratio = 0.2\n", hht},
        Case{rolling, {}}})
    for (const std::string damping : {"", "damping = 20.0\n"}) {
      CAPTURE(friction_keys, damping, settings.size());
      SimulationRun run(escaping_model(friction_keys + damping, settings));
      TangentialLosses before{};
      Real grown_with_escaped = 0;
      run.run([&] {
        const TangentialLosses now = losses_of(run);
        for (int kind = 0; kind < kLossKinds; ++kind) CHECK(now.of[kind] >= before.of[kind]);
        before = now;
        const Real all = dissipated(run);
        if (damping.empty())
          CHECK(near(sum_of(now), all, {.relative = 1e-11}));
        else
          CHECK(sum_of(now) <= all);
        grown_with_escaped = run.complete_state().carried_out.losses.of[kFrictionLoss];
      });
      CHECK(run.complete_state().carried_out.removed > 10);
      CHECK(grown_with_escaped > 1e-3 * before.of[kFrictionLoss]);
      CHECK(before.of[kFrictionLoss] > 0.05 * run.exchanged());
      for (const LossKind kind : {kRollingLoss, kTwistingLoss})
        CHECK((before.of[kind] > 1e-3 * run.exchanged()) == (friction_keys == rolling));
      if (!damping.empty()) CHECK(sum_of(before) < 0.9 * dissipated(run));
    }
}

}  // namespace scree
