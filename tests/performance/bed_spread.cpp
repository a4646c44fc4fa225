#include "bed_spread.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "base/error.hpp"
#include "bed_cases.hpp"
#include "coupling/coupled_step.hpp"
#include "dem/particles/particle_store.hpp"
#include "physics/particle_mass.hpp"

namespace scree {
namespace {

constexpr Real kSmallest = 0.5, kStiffness = 2e5, kDamping = 25;  // [m], [N/m], [N s/m]
// Nearly critical for two of the smallest spheres.
constexpr Real kRelaxingDamping = 600;
constexpr int kRelaxingSteps = 4000;

// Solid fraction a little above that of a random close packing of this spread: equal spheres have 0.64.
Real solid_fraction(Real spread) { return spread > 5 ? 0.74 : spread > 2 ? 0.70 : 0.66; }

// Radii with number densities ~ r^-4, by quantiles.
std::vector<Real> radii(Real spread) {
  std::vector<Real> out;
  for (std::int64_t i = 0; i < kTileParticles; ++i) {
    const Real share = (static_cast<Real>(i) + 0.5) / static_cast<Real>(kTileParticles);
    out.push_back(kSmallest * std::cbrt(1 / (1 - share * (1 - std::pow(spread, -3)))));
  }
  return out;
}

Model empty_box(Vec3 size, Real damping) {
  Model model;
  model.space.dimension = 3;
  model.space.min = {0, 0, 0}, model.space.max = size;
  model.space.boundary.fill(Boundary::periodic);
  model.contact.material_names = {"sphere"};
  model.contact.laws = {{kStiffness, damping, 1, false}};
  model.contact.skin = 0.2 * kSmallest;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.integrator.substeps = 10;
  model.time.end = 1, model.time.step = model.integrator.substeps * kSphereStep;
  return model;
}

void add_sphere(ParticleSet& set, Vec3 position, Real radius) {
  set.position.push_back(position), set.velocity.push_back({});
  set.radius.push_back(radius), set.mass.push_back(std::pow(radius / kSmallest, 3));
  set.material.push_back(0);
}

// Spheres at random positions push each other apart.
std::vector<Vec3> relaxed(const std::vector<Real>& radius, Real width) {
  Model model = empty_box({width, width, width}, kRelaxingDamping);
  std::mt19937 engine(1);
  const auto random = [&] { return width * static_cast<Real>(engine()) / 4294967296.0; };
  for (const Real r : radius) {
    const Real x = random(), y = random(), z = random();
    add_sphere(model.particles, {x, y, z}, r);
  }
  count_particles(model.particles, 1);
  StageTimers timers;
  const std::unique_ptr<Backend> backend = make_cpu_backend(model);
  backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
  BodyCoupling link(model);
  CoupledStep step(model, *backend, link, timers);
  MultibodyState bodies;
  step.start(bodies);
  const std::vector<Real> times(static_cast<std::size_t>(kRelaxingSteps / model.integrator.substeps));
  step.explicit_steps(bodies, times, model.time.step, times.back() + model.time.step);
  const ParticleLedger ledger = backend->reports().ledger(0);
  fmt::print("relaxed tile: kinetic energy {:.2e} J, {:.2f} contacts per sphere\n",
             ledger.kinetic / kTileParticles, 2 * static_cast<Real>(ledger.contacts) / kTileParticles);
  std::vector<Vec3> out;
  for (const Particle& record : backend->particles().records()) out.push_back(record.position);
  return out;
}

}  // namespace

Model spread_box(Real spread, std::int64_t particles) {
  if (particles < kTileParticles || particles % kTileParticles != 0)
    throw InputError(fmt::format("--particles {}: must be a multiple of {}", particles, kTileParticles));
  const std::int64_t tiles = particles / kTileParticles;
  std::int64_t rows = static_cast<std::int64_t>(std::sqrt(static_cast<double>(tiles)));
  while (tiles % rows != 0) --rows;
  const std::vector<Real> radius = radii(spread);
  Real volume = 0;
  for (const Real r : radius) volume += sphere_mass(r, 1);
  const Real width = std::cbrt(volume / solid_fraction(spread));
  const std::vector<Vec3> tile = relaxed(radius, width);
  Model model =
      empty_box({width * static_cast<Real>(tiles / rows), width * static_cast<Real>(rows), width}, kDamping);
  for (std::int64_t t = 0; t < tiles; ++t)
    for (std::size_t i = 0; i < tile.size(); ++i)
      add_sphere(model.particles,
                 tile[i] + Vec3{width * static_cast<Real>(t / rows), width * static_cast<Real>(t % rows), 0},
                 radius[i]);
  count_particles(model.particles, 1);
  return model;
}

}  // namespace scree
