// Settled packings in implicit steps far above the contact time: h sqrt(K/m) = 3.2.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

const std::string kBoxOfSpheres = R"(
gravity = [0.0, 0.0, -9.8066]
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [2.02, 2.02, 3.0]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
[time]
end = 1.0
step = 1e-3
[[contact.pairs]]
stiffness = 1e7
damping = 10.0
[[particles]]
name = "spheres"
kind = "lattice"
origin = [0.055, 0.055, 0.0501]
spacing = [0.1005, 0.1005, 0.1002]
size = [20, 20, 20]
radius = { kind = "uniform", min = 0.046, max = 0.05 }
mass = 1.0
random_velocity = 0.5
seed = 3
)";

constexpr Real kSettlingStep = 1e-4, kSettlingDamping = 700;  // [s], [N s/m]

void take_over_at_rest(const SimulationRun& run, Model& model) {
  const std::vector<ParticleRecord> records = run.particles();
  for (std::size_t i = 0; i < records.size(); ++i) {
    model.particles.position[i] = records[i].position;
    model.particles.velocity[i] = {};
  }
}

// Explicit steps with strong damping: `fall` [s] in one go, then `bursts` of about a quarter of the slowest
// swing of the packing, each from rest, which takes what contact damping leaves in such swings.
Model settled(const Model& loose, Real fall, int bursts) {
  constexpr Real kBurst = 6e-3;  // [s]
  Model model = loose;
  for (KelvinVoigt& law : model.contact.laws) law.normal_damping = kSettlingDamping;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.time.step = model.time.max_step = kSettlingStep;
  model.output.history_interval = model.output.snapshot_interval = 0.1;
  for (int burst = 0; burst <= bursts; ++burst) {
    model.time.end = burst == 0 ? fall : kBurst;
    SimulationRun run(model);
    run.run();
    const ParticleLedger ledger = run.particle_ledger();
    Real unbalanced = 0; for (auto& p : run.particles()) unbalanced = std::max(unbalanced, norm(p.force));
    if (burst % 20 == 0) std::cout << burst << " kinetic " << ledger.kinetic << " contacts " << ledger.contacts << " unbal " << unbalanced << "\n";
    take_over_at_rest(run, model);
  }
  Model out = loose;
  out.particles = model.particles;
  return out;
}

// Takes 120 implicit steps of 1 ms from rest.
void check_rests(const std::string& what, const Model& settled_model, Real damping, Real hht_alpha) {
  constexpr Real kStep = 1e-3;
  constexpr int kSteps = 120;
  Model model = settled_model;
  for (KelvinVoigt& law : model.contact.laws) law.normal_damping = damping;
  model.integrator.hht_alpha = hht_alpha;
  model.time.step = model.time.max_step = kStep;
  model.time.end = kSteps * kStep;
  model.output.history_interval = model.output.snapshot_interval = 0;
  SimulationRun run(model);
  const Ledger start = run.ledger();
  Real largest_kinetic = 0, largest_gain = 0;
  run.run([&] {
    const Ledger now = run.ledger();
    largest_kinetic = std::max(largest_kinetic, now.kinetic);
    largest_gain = std::max(largest_gain, now.mechanical() - start.mechanical());
  });
  const StepCounts& n = run.counts();
  const Real steps = static_cast<Real>(n.steps);
  std::cout << fmt::format("{}, C = {}, alpha = {}: {:.2f} Newton and {:.1f} linear iterations per step, kinetic energy "
                           "at most {:.2e} J, {} contacts, gain {:.2e}\n",
                           what, damping, hht_alpha, static_cast<Real>(n.newton_iterations) / steps,
                           static_cast<Real>(n.linear_iterations) / steps, largest_kinetic,
                           run.particle_ledger().contacts, largest_gain);
  CHECK(n.steps == kSteps);
  CHECK(n.rejected_newton == 0);
}

}  // namespace

TEST_CASE("a settled heap of 900 discs rests in implicit steps") {
  const Model heap = settled(input_model("examples/heap_900.toml"), 1.0, 200);
  for (const Real damping : {10.0, 100.0})
    for (const Real hht_alpha : {0.0, -0.1}) check_rests("900 discs", heap, damping, hht_alpha);
}

TEST_CASE("a settled box of 8,000 spheres rests in implicit steps") {
  const Model box = settled(model_of(kBoxOfSpheres), 1.5, 150);
  for (const Real damping : {10.0, 100.0})
    for (const Real hht_alpha : {0.0, -0.1}) check_rests("8,000 spheres", box, damping, hht_alpha);
}
