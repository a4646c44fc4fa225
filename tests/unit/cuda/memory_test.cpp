// Predicted device memory against the memory that the run takes.
#include "dem/backend/device.hpp"
#include "model/builder/particle_file.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/particle_columns.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {
namespace {

// Memory of the model's run at the start, with reports; for explicit runs after steps and a list.
double taken(const Model& model) {
  const std::size_t before = device_memory_in_use();
  const std::unique_ptr<Backend> backend = make_cuda_backend(model);
  StageTimers timers;
  backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
  backend->list().build(model.contact.skin, timers);
  backend->particles().initial_forces();
  if (model.integrator.particles == ParticleIntegrator::velocity_verlet) {
    backend->start_run(1e-7)->take_steps(4, false, timers);
    backend->list().build(model.contact.skin, timers);
  }
  backend->reports().ledger(0);
  backend->reports().start_output();
  backend->reports().output();
  return static_cast<double>(device_memory_in_use() - before);
}

void check_estimate(const Model& model) {
  const double bytes = taken(model);
  CHECK(near(static_cast<double>(device_memory(model)), bytes, {.relative = 0.1}));
}

// Settled spheres with friction: tiles of a bed, side by side.
Model frictional_bed() {
  constexpr int kTiles = 30;
  constexpr Real kWidth = 25, kRadius = 0.5, kStiffness = 2e5;
  const ParticleColumns tile = read_particle_file(SCREE_SOURCE_DIR "/tests/reference/bed_tile.h5", 3);
  Model model;
  model.space.dimension = model.particles.dimension = 3;
  model.space.min = {-kRadius, -kRadius, 0};
  model.space.max = {kTiles * kWidth + kRadius, kWidth + kRadius, 20};
  model.contact.material_names = {"sphere"};
  model.contact.laws = {{kStiffness, 25, 1, false}};
  model.contact.friction = {{0.5, Real(2) / 7 * kStiffness, 0, 0}};
  model.contact.skin = 0.1;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  const std::vector<Real>&x = tile.at("x"), &y = tile.at("y"), &z = tile.at("z");
  ParticleSet& set = model.particles;
  for (int t = 0; t < kTiles; ++t)
    for (std::size_t i = 0; i < x.size(); ++i) {
      set.position.push_back({x[i] + t * kWidth, y[i], z[i]}), set.velocity.push_back({});
      set.radius.push_back(kRadius), set.mass.push_back(1), set.material.push_back(0);
    }
  count_particles(set, model.contact.materials());
  return model;
}

}  // namespace

TEST_CASE("the predicted device memory is what the run takes") {
  for (const auto& [c, squares] : {std::pair{kBoxes[0], 0}, {kBoxes[4], 0}, {kBoxes[6], 0}, {kBoxes[6], 600}})
    for (const auto& [integrator, precision] : {std::pair{ParticleIntegrator::hht, Precision::full},
                                                {ParticleIntegrator::velocity_verlet, Precision::full},
                                                {ParticleIntegrator::velocity_verlet, Precision::mixed}}) {
      CAPTURE(c.name, squares, static_cast<int>(integrator), static_cast<int>(precision));
      Model model = random_box(c, squares > 0 ? 50000 : 300000, 5);
      const Real scale = c.dimension == 2 ? 60 : squares > 0 ? 8 : 14;
      for (Vec3* corner : {&model.space.min, &model.space.max}) *corner = scale * *corner;
      for (Vec3& position : model.particles.position) position = scale * position;
      model.integrator.particles = integrator, model.integrator.precision = precision;
      model.contact.skin = 0.02;
      if (squares > 0) add_floor(model, squares);
      check_estimate(model);
    }
}

TEST_CASE("the predicted device memory of settled spheres with friction is what the run takes") {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    CAPTURE(static_cast<int>(precision));
    Model model = frictional_bed();
    model.integrator.precision = precision;
    check_estimate(model);
  }
}

// Except for the transfer buffers, whose size does not depend on the number of particles.
TEST_CASE("settled spheres with friction take at most 800 bytes each, in steps and while lists are built") {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    CAPTURE(static_cast<int>(precision));
    Model model = frictional_bed();
    model.integrator.precision = precision;
    const std::size_t before = device_memory_in_use();
    const std::unique_ptr<Backend> backend = make_cuda_backend(model);
    StageTimers timers;
    backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
    backend->list().build(model.contact.skin, timers);
    backend->particles().initial_forces();
    const std::unique_ptr<ExplicitRun> run = backend->start_run(1e-4);
    run->take_steps(50, true, timers);
    backend->list().build(model.contact.skin, timers);  // including contact histories
    run->take_steps(50, false, timers);
    CHECK(backend->particles().contacts().keys.size() > 3 * model.particles.size());
    constexpr std::size_t kPerContact = sizeof(std::int64_t) + 3 * sizeof(Real);
    const std::size_t rooms =
        kRecordsAtOnce * sizeof(Particle) +
        static_cast<std::size_t>(kRowsAtOnce) * (kContactsPerRow * kPerContact + sizeof(Index));
    CHECK(device_memory_in_use() - before - rooms <= 800 * model.particles.size());
  }
}

}  // namespace scree
