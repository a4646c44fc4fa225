// Settled packings in implicit steps far above the contact time: h sqrt(K/m) = 3.2.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

// Square layers, each in the hollows of the one below; gaps and different radii let them fall into disorder.
const std::string kBoxOfSpheres = R"(
gravity = [0.0, 0.0, -9.8066]
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [2.07, 2.07, 2.0]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
[time]
end = 1.0
step = 1e-3
control = "fixed"
[integrator]
particles = "hht"
[[contact.pairs]]
stiffness = 1e7
damping = 10.0
[[particles]]
name = "even_layers"
kind = "lattice"
origin = [0.055, 0.055, 0.05]
spacing = [0.1005, 0.1005, 0.1425]
size = [20, 20, 10]
radius = { kind = "uniform", min = 0.049, max = 0.05 }
mass = 1.0
seed = 3
[[particles]]
name = "odd_layers"
kind = "lattice"
origin = [0.105, 0.105, 0.12125]
spacing = [0.1005, 0.1005, 0.1425]
size = [20, 20, 10]
radius = { kind = "uniform", min = 0.049, max = 0.05 }
mass = 1.0
seed = 4
)";

// Sets the particles of `model` to the positions of those of `run`, at rest.
void take_over_at_rest(const SimulationRun& run, Model& model) {
  const std::vector<Particle> records = run.particles();
  for (std::size_t i = 0; i < records.size(); ++i) {
    model.particles.position[i] = records[i].position;
    model.particles.velocity[i] = {};
  }
}

// Fraction of the particles on which more than 5 % of their weight is not balanced.
Real unbalanced_share(const SimulationRun& run, const Model& model) {
  const std::vector<Particle> records = run.particles();
  const auto unbalanced = [&](const Particle& p) {
    return norm(p.force) >
           0.05 * model.particles.mass[static_cast<std::size_t>(p.global_id)] * norm(model.gravity);
  };
  return static_cast<Real>(std::count_if(records.begin(), records.end(), unbalanced)) /
         static_cast<Real>(records.size());
}

// The model at rest after explicit steps with strong damping: `fall` [s] in one go, then bursts of about a
// quarter of the packing's slowest oscillation, each from rest, which removes the energy that contact
// damping leaves in such oscillations.
Model settled(const Model& loose, Real fall, int bursts) {
  constexpr Real kBurst = 6e-3, kSettlingStep = 1e-4, kSettlingDamping = 700;  // [s], [s], [N s/m]
  Model model = loose;
  for (NormalLawParameters& law : model.contact.laws) law.normal_damping = kSettlingDamping;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.time.step = model.time.max_step = kSettlingStep;
  model.output.history_interval = model.output.snapshot_interval = fall;
  Real unbalanced = 1;
  for (int burst = 0; burst <= bursts; ++burst) {
    model.time.end = burst == 0 ? fall : kBurst;
    SimulationRun run(model);
    run.run();
    unbalanced = unbalanced_share(run, model);
    take_over_at_rest(run, model);
  }
  std::cout << fmt::format("settled: {:.2f} % of the particles are not in balance\n", 100 * unbalanced);
  CHECK(unbalanced < 0.05);
  Model out = loose;
  out.particles = model.particles;
  return out;
}

// Takes 120 implicit steps of 1 ms from rest, each at full length.
void check_rests(const std::string& what, const Model& settled_model, Real damping, Real hht_alpha) {
  constexpr Real kStep = 1e-3;
  constexpr int kSteps = 120;
  constexpr Real kEnergyRise = 1e-9;  // [J]
  constexpr Real kPhysical =
      1e-3;  // relative to the energy of a fall by the radius: settling energy per particle
  Model model = settled_model;
  for (NormalLawParameters& law : model.contact.laws) law.normal_damping = damping;
  model.integrator.hht_alpha = hht_alpha;
  model.time.step = model.time.max_step = kStep;
  model.time.end = kSteps * kStep;
  model.output.history_interval = model.output.snapshot_interval = 0;
  SimulationRun run(model);
  const Real start = run.ledger().mechanical(), count = static_cast<Real>(model.particles.size());
  Real largest_kinetic = 0, largest_rise = 0;
  run.run([&] {
    const Ledger now = run.ledger();
    largest_kinetic = std::max(largest_kinetic, now.kinetic);
    largest_rise = std::max(largest_rise, now.mechanical() - start);
  });
  const StepCounts& n = run.counts();
  const Real fall = model.particles.mass[0] * norm(model.gravity) * model.particles.radius[0];
  std::cout << fmt::format(
      "{}, C = {}, alpha = {}: per step {:.2f} Newton and {:.1f} linear iterations; kinetic energy at most "
      "{:.1e} J "
      "per particle; {} contacts\n",
      what, damping, hht_alpha, static_cast<Real>(n.newton_iterations) / kSteps,
      static_cast<Real>(n.linear_iterations) / kSteps, largest_kinetic / count,
      run.particle_ledger().contacts);
  CAPTURE(what, damping, hht_alpha);
  CHECK(measured("rest/" + what + ", steps", "", in_range(static_cast<Real>(n.steps), kSteps, kSteps)));
  note("rest/" + what + ", Newton", "", static_cast<Real>(n.newton_iterations) / kSteps);
  note("rest/" + what + ", linear", "", static_cast<Real>(n.linear_iterations) / kSteps);
  CHECK(n.rejected_newton == 0);
  CHECK(keeps(largest_kinetic / count / fall, {.promise = kPhysical, .measured = 1.5e-4}));
  CHECK(largest_rise < kEnergyRise);
  CHECK(run.particle_ledger().contacts > 3 * static_cast<std::int64_t>(count) / 2);
}

void check_rests(const std::string& what, const Model& settled_model) {
  CHECK(settled_model.integrator.residual_tolerance == 1e-8);  // scaled: the promise
  for (const Real damping : {10.0, 100.0})
    for (const Real hht_alpha : {0.0, -0.1}) check_rests(what, settled_model, damping, hht_alpha);
}

}  // namespace

TEST_CASE("a settled heap of 900 discs takes every implicit step at full length") {
  check_rests("900 discs",
              settled(input_model("examples/heap_900.toml", {"integrator.hht_alpha=0.0"}), 1, 200));
}

TEST_CASE("a settled box of 8,000 spheres takes every implicit step at full length") {
  check_rests("8,000 spheres", settled(model_of(kBoxOfSpheres), 0.5, 150));
}
