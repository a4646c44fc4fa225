// Free particles in a box, in mixed precision on a GPU or in double on either backend.
#pragma once

#include "dem/backend/device.hpp"
#include "partition/subdomain.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"

namespace scree {

inline Model box_model(Real side, Precision precision) {
  Model model;
  model.space.min = {0, 0, 0}, model.space.max = {side, side, side};
  model.contact.material_names = {"sphere"};
  model.contact.laws = {{2e5, 25, 1, false}};
  model.contact.skin = 0.1;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.integrator.precision = precision;
  return model;
}

inline void add_sphere(Model& model, Vec3 position, Vec3 velocity) {
  ParticleSet& set = model.particles;
  set.position.push_back(position), set.velocity.push_back(velocity);
  set.radius.push_back(0.5), set.mass.push_back(1), set.material.push_back(0);
  count_particles(set, model.contact.materials());
}

struct MixedTestRun {
  MixedTestRun(const Model& of, bool cuda)
      : model(of), backend(cuda ? make_cuda_backend(model) : make_cpu_backend(model)) {
    measured_on_gpu(device_name());
    backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
    backend->list().set_body_motion({});
    backend->list().build(model.contact.skin, timers);
    backend->particles().initial_forces();
  }
  void advance(Real h, Index steps) {
    REQUIRE(backend->start_run(h)->take_steps(steps, false, timers).closed == steps);
  }

  Model model;
  StageTimers timers;
  std::unique_ptr<Backend> backend;
};

}  // namespace scree
