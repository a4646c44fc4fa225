// Speed of explicit steps on a settled 2D bed of frictionless discs: particle-steps per second for 1e4 to 1e6
// discs.
//
// A tile of 100 x 100 discs, periodic in x, settles under gravity; it is then repeated in x, so that every
// size has the same contacts. Prints CPU time alone. Usage: dense_bed [particles ...]
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>

#include "coupling/coupled_step.hpp"

namespace scree {
namespace {

constexpr int kTileSide = 100;
constexpr Real kRadius = 0.05, kSpacing = 0.102, kTileWidth = kTileSide * kSpacing;

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Model bed_model(int tiles, Real step, Real damping) {
  Model model;
  model.space.dimension = 2;
  model.space.min = {0, 0, 0}, model.space.max = {tiles * kTileWidth, 1.5 * kTileWidth, 0};
  model.space.boundary = {Boundary::periodic, Boundary::periodic, Boundary::wall, Boundary::wall};
  model.gravity = {0, -9.8066, 0};
  model.contact.material_names = {"disc"};
  model.contact.laws = {{1e7, damping, 1, false}};
  model.contact.skin = 0.2 * kRadius;
  model.walls = {{"floor", {0, 0, 0}, {0, 1, 0}, 0}};
  model.time.end = 1, model.time.step = 10 * step;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.integrator.substeps = 10;
  return model;
}

void add_disc(Model& model, Vec3 position) {
  ParticleSet& set = model.particles;
  set.position.push_back(position), set.velocity.push_back({});
  set.radius.push_back(kRadius), set.mass.push_back(1), set.material.push_back(0);
}

struct Run {
  explicit Run(const Model& m)
      : model(m), backend(make_cpu_backend(model)), link(model), step(model, *backend, link, timers) {
    backend->load(initial_records(model.particles, Subdomain(model.space)), {});
    step.start(bodies);
  }
  void advance(int steps) {
    const std::vector<Real> times(static_cast<std::size_t>(steps / model.integrator.substeps));
    step.explicit_steps(bodies, times, model.time.step);
  }

  Model model;
  StageTimers timers;
  std::unique_ptr<Backend> backend;
  BodyLink link;
  CoupledStep step;
  MultibodyState bodies;
};

std::vector<Vec3> settled_tile() {
  Model model = bed_model(1, 1e-4, 700);
  std::mt19937 engine(1);
  const auto jitter = [&] { return 1e-3 * (static_cast<Real>(engine()) / 4294967296.0 - 0.5); };
  for (int row = 0; row < kTileSide; ++row)
    for (int column = 0; column < kTileSide; ++column)
      add_disc(model,
               {(column + 0.25 + 0.5 * (row % 2)) * kSpacing + jitter(), kRadius + 0.09 * row + jitter(), 0});
  Run run(model);
  run.advance(20000);
  const ParticleLedger ledger = run.backend->ledger(0);
  std::printf("settled tile: kinetic energy %.2e J per disc, %.2f contacts per disc\n", ledger.kinetic / 1e4,
              2 * static_cast<double>(ledger.contacts) / 1e4);
  std::vector<Vec3> out;
  for (const ParticleRecord& record : run.backend->records()) out.push_back(record.position);
  return out;
}

void measure(const std::vector<Vec3>& tile, int particles) {
  const int tiles = std::max(1, particles / static_cast<int>(tile.size()));
  Model model = bed_model(tiles, 1e-5, 100);
  for (int t = 0; t < tiles; ++t)
    for (const Vec3& p : tile) add_disc(model, p + Vec3{t * kTileWidth, 0, 0});
  Run run(model);
  run.advance(20);
  const int steps = std::max(40, 20000000 / static_cast<int>(model.particles.size()));
  const std::int64_t builds = run.backend->list_builds();
  const double start = cpu_seconds();
  run.advance(steps);
  const double seconds = cpu_seconds() - start;
  const double updates = static_cast<double>(model.particles.size()) * steps;
  std::printf(
      "%8zu discs: %.3g particle-steps/s, %.1f ns each, %d steps, %lld list builds, %.2f listed per disc\n",
      model.particles.size(), updates / seconds, 1e9 * seconds / updates, steps,
      static_cast<long long>(run.backend->list_builds() - builds),
      static_cast<double>(run.backend->list_entries()) / static_cast<double>(model.particles.size()));
}

}  // namespace
}  // namespace scree

int main(int count, char** values) {
  MPI_Init(&count, &values);
  std::vector<int> sizes;
  for (int i = 1; i < count; ++i) sizes.push_back(std::atoi(values[i]));
  if (sizes.empty()) sizes = {10000, 100000, 1000000};
  const std::vector<scree::Vec3> tile = scree::settled_tile();
  for (const int size : sizes) scree::measure(tile, size);
  MPI_Finalize();
}
